#pragma once
/// What a sweep of a model that is not linear comes to at each speed, in the form in which it is judged
/// (strength/class_judgement.hpp) and drawn: the worst that the train may do there.
///
/// At each speed asked for, section by section: of the motions that are stable (or not judged) the one with the largest half range, with its
/// mean, extremes and orders; where none is stable, mean, lowest and highest value of the run in time (no orders; heat
/// is not known, and 0). Speeds with neither are left out, and listed. Points of stable curves between two speeds that are
/// higher than at both of them are peaks. There are no criticals: orders meet no natural frequency of a train whose
/// contacts open.
#include <drev/solvers/nonlinear_sweep.hpp>
#include <drev/solvers/periodic/linear_sweep.hpp>

#include <vector>

namespace drev {

struct WorstMotions {
  LinearSweep sweep;            ///< its speeds are those that have an answer
  std::vector<double> by_runs;  ///< speeds at which a run's statistics stand in it [rad/s]
  std::vector<double> missing;  ///< speeds without any answer [rad/s]
};

WorstMotions worst_motions(const NonlinearSweep& sweep);

}  // namespace drev
