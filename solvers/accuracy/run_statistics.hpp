#pragma once
/// What run_to_accuracy() gives of motion past its horizon, where two runs do not agree: time averages over
/// batches, means over runs that start beside the first, orders of single cycles, quantiles, each with its 95 %
/// confidence interval (estimate.hpp). And the samples of whole cycles that orders are of. Internal to the folder.
#include <drev/solvers/accuracy/accuracy.hpp>
#include <drev/solvers/periodic/spectrum.hpp>

#include <map>
#include <string>
#include <vector>

namespace drev {

struct Watched;

/// By the name of a figure: the line of one cycle's spectrum that it is the amplitude of.
using OrderLines = std::map<std::string, std::size_t>;

/// Whole cycles at the end of a record of samples.
struct CycleRecord {
  std::size_t begin = 0, end = 0, cycles = 0;  ///< first and last sample, both of them of the record
};
/// As many cycles (s) of samples `every` (s) apart as fit behind the part left out, in [0, 1), or else into the run.
CycleRecord last_cycles(const std::vector<double>& samples, double every, double cycle, double left_out);

/// From sample begin to sample end, both of them in it.
std::vector<double> samples_between(const std::vector<double>& all, std::size_t begin, std::size_t end);

/// Amplitudes of a record of whole cycles; its first and last sample, the same phase, as their mean.
Spectrum cycle_spectrum(std::vector<double> record, double every);

/// Replaces the figures of the result that do not keep the accuracy by statistics, and adds the time averages. fine: the
/// finer of the two runs compared, with samples `every` (s) apart.
void add_statistics(const System& system, const AccuracyOptions& options, const Watched& fine, double every,
                    const OrderLines& orders, AccuracyResult& result);

}  // namespace drev
