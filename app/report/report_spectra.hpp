#pragma once
/// Spectra of what the report recorded: of the end of the run, at most its second half, over whole cycles
/// where the model has a cycle; Hann window, mean removed.
#include "app/base/json_values.hpp"
#include "app/report/report_history.hpp"

namespace drev::app {

/// begin: s, nothing before it counts. cycle: s, 0: none, at the speed `nominal` of the reference shaft [rad/s]; the
/// cycles are those of the speed at which it really turned. highest: the highest frequency of interest [Hz].
/// {speed (mean of the reference shaft from begin on, rad/s), from, to, samples, resolution_Hz,
/// line_Hz, pooled, channels: [{name, unit, amplitude (base64, float), peaks: [{frequency_Hz, amplitude}]}]};
/// line_Hz = pooled resolution_Hz, amplitude k is the largest of the lines in (k line_Hz, (k + 1) line_Hz].
/// Null for a run of fewer than 64 samples, or 16 in the part looked at.
Json spectra_object(const ReportHistory& history, double begin, double cycle, double nominal, double highest);

/// Little-endian numbers as text.
std::string base64(const void* data, std::size_t bytes);
template <class T>
std::string base64(const std::vector<T>& values) {
  return base64(values.data(), values.size() * sizeof(T));
}

}  // namespace drev::app
