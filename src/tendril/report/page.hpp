#pragma once
// A result file as one self-contained HTML page. The page is a template (web/, built by Vite and embedded at build
// time) with the text of the result inside: tokens are copied, never read and printed again, so the page holds the
// numbers of the result file bit for bit. Nothing is computed here. Solver states are left out; above the size limit
// rows of the fields are thinned (junctions of the contact pattern stay) and the page says so.

#include <cstddef>
#include <string>
#include <string_view>

namespace tendril::report {

struct PageOptions {
  std::size_t max_bytes = 5'000'000;  // fields are thinned so that page size <= max_bytes
  std::size_t min_rows = 101;         // rows a step keeps at least; then steps lose their fields, evenly, instead
};

/// Whether this build has the page; `page` needs it.
bool available();

/// The page of a result file's text. Throws std::invalid_argument when the text is not JSON of a result's shape.
std::string page(std::string_view result, const PageOptions& options = {});

/// The same with another template: `"TENDRIL_RESULT"` in it, there exactly once, gives way to the result.
std::string fill(std::string_view page_template, std::string_view result, const PageOptions& options = {});

}  // namespace tendril::report
