#pragma once
// The parts of verify_rows(): closed forms, and what the solver must reproduce.

#include "verify.hpp"

namespace tendril::app {

void append_closed_form_rows(std::vector<VerifyRow>& rows);
void append_solver_rows(std::vector<VerifyRow>& rows);

}  // namespace tendril::app
