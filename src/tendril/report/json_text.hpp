#pragma once
// JSON as text: finds the extent of values without reading them, so that they can be copied exactly. Views point into
// the text given. Broken JSON throws std::invalid_argument with the byte where it breaks.

#include <string>
#include <string_view>
#include <vector>

namespace tendril::report {

struct TextMember {
  std::string_view key;  // without quotes, escapes as written
  std::string_view value;
};

/// Members of an object, items of an array, in order; `value` may have white space around it.
std::vector<TextMember> members(std::string_view value);
std::vector<std::string_view> items(std::string_view value);

/// The value of a member; empty when it is not there.
std::string_view find(const std::vector<TextMember>& object, std::string_view key);

/// Append without white space between tokens; `<` inside strings becomes \u003c, so that no `</script` or `<!--` of the
/// result can end the element that holds it.
void append_compact(std::string& out, std::string_view value);

}  // namespace tendril::report
