#pragma once
/// Methods in time on the command line: their names, what --help says of them, and what is wrong with one.
/// All of it is made from methods().
#include <drev/core/error.hpp>
#include <drev/core/system.hpp>

#include <string>
#include <vector>

namespace drev::app {

/// The part of --help on methods: each with its numbers, their ranges, and what it is.
std::string methods_help();
/// A finding if there is no such stepping method, or its numbers are out of their ranges.
void check_step_scheme(const char* option, const std::string& text, std::vector<Finding>& findings);

/// A finding if something keeps the model from exact propagation.
void check_exact(const char* option, const System& system, std::vector<Finding>& findings);

}  // namespace drev::app
