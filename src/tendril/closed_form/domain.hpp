#pragma once
// Arguments outside the range where a closed form holds: one exception, std::domain_error, that names quantity, value
// and bound.

#include <sstream>
#include <stdexcept>

namespace tendril::closed_form {

/// Throws unless `inside` holds; a NaN argument must make `inside` false at the call.
inline void require(bool inside, const char* quantity, double value, const char* bound) {
  if (inside) return;
  std::ostringstream text;
  text.precision(17);
  text << quantity << " = " << value << ": must be " << bound;
  throw std::domain_error(text.str());
}

}  // namespace tendril::closed_form
