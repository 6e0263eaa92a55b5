#pragma once
/// A sweep judged by what its sections may carry, as text and JSON.
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
  std::vector<std::string> notes = {};  ///< how motions with contacts that open stand in the sweep
};

std::string class_as_text(const std::vector<ClassCase>& cases);
/// As docs/results.schema.json describes it, kind "class". mass_elastic: nodes and joints (report_model.hpp).
Json class_object(const std::vector<ClassCase>& cases, const Json& mass_elastic);
/// The rules that were used, and what is not judged.
std::vector<std::string> class_rules(const Strength& strength);
/// closed: contacts are taken as closed.
std::vector<std::string> class_limits(bool closed);

}  // namespace drev::app
