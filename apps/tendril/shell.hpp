#pragma once
// Shell completion and the man page, from the commands and options that the program really has.

#include <CLI/CLI.hpp>
#include <string>

namespace tendril::app {

/// `tendril completion SHELL`: the script for bash, zsh or fish.
int complete(const CLI::App& app, const std::string& shell);

/// tendril(1) as roff.
std::string man_page(const CLI::App& app, const std::string& version);

}  // namespace tendril::app
