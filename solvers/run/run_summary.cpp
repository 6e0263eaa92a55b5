#include <drev/solvers/run/run_summary.hpp>

#include <sstream>

namespace drev {

const char* to_text(RunStatus status) {
  switch (status) {
    case RunStatus::success:
      return "success";
    case RunStatus::energy_error:
      return "energy_error";
    case RunStatus::unstable:
      return "unstable";
    case RunStatus::no_convergence:
      return "no_convergence";
    case RunStatus::not_finite:
      return "not_finite";
    case RunStatus::interrupted:
      return "interrupted";
  }
  return "unknown";
}

std::string RunSummary::brief_report() const {
  std::ostringstream text;
  text << scheme;
  if (tolerance > 0.0)
    text << ", tolerance " << tolerance;
  else if (step > 0.0)
    text << ", h = " << step << " s";
  text << ": " << to_text(status) << " at t = " << t_end << " s, " << steps << " steps";
  if (tolerance > 0.0) text << " (" << rejected << " rejected)";
  if (forced > 0) text << ", " << forced << " above their share of the tolerance";
  if (located > 0) text << ", " << located << " contact changes located";
  if (fallbacks > 0) text << ", " << fallbacks << " steps with a force inside its jump";
  if (step > 0.0 || tolerance > 0.0)
    text << " (" << halved << " halved), " << iterations << " iterations, ";
  else
    text << ", " << contact_changes << " contact changes, ";
  text << "energy error " << energy.relative_error();
  if (!reason.empty()) text << "; " << reason;
  for (const std::string& warning : warnings) text << "; warning: " << warning;
  return text.str();
}

}  // namespace drev
