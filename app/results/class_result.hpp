#pragma once
/// A sweep judged by the limits of its sections, as text and JSON.
#include <drev/solvers/strength/class_judgement.hpp>

#include <string>
#include <vector>

#include "app/results/sweep_result.hpp"

namespace drev::app {

/// One condition of the engine: all cylinders fired, or one that misfires.
struct ClassCase {
  std::string name;  ///< "normal", "misfire"
  SweepRequest request;
  LinearSweep sweep;
  ClassJudgement judgement;
  std::vector<std::string> notes = {};  ///< sentences on the sweep
};

std::string class_as_text(const std::vector<ClassCase>& cases);
/// The result as an object of kind "class" of docs/results.schema.json. mass_elastic: nodes and joints
/// (report_model.hpp).
Json class_object(const std::vector<ClassCase>& cases, const Json& mass_elastic);
/// Sentences on the rules that were used and on what is not judged.
std::vector<std::string> class_rules(const Strength& strength);
/// Sentences on the limits of the method. closed: contacts are treated as closed.
std::vector<std::string> class_limits(bool closed);

}  // namespace drev::app
