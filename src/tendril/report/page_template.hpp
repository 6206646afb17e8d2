#pragma once
// The embedded page; its definition is written by the build (cmake/embed_page.cmake). Empty in a build without it.

#include <string_view>

namespace tendril::report {

std::string_view page_template();

}  // namespace tendril::report
