#pragma once
/// Spectra of the recorded channels of a report over the end of the run, at most its second half, and over
/// whole cycles if the model has a cycle; Hann window, mean removed.
#include "app/base/json_values.hpp"
#include "app/report/report_history.hpp"

namespace drev::app {

/// begin: time from which samples are used [s]. cycle: time of a cycle [s] at the speed `nominal` of the
/// reference shaft [rad/s], 0: none; the cycles used are those of its actual speed. highest: highest
/// frequency of interest [Hz]. {speed (mean of the reference shaft from begin on, rad/s), from, to, samples,
/// resolution_Hz, line_Hz, pooled, channels: [{name, unit, amplitude (base64, float), peaks: [{frequency_Hz,
/// amplitude}]}]}; line_Hz = pooled resolution_Hz, amplitude k is the largest of the lines in (k line_Hz, (k
/// + 1) line_Hz]. Null for a run of fewer than 64 samples, or 16 in the part looked at.
Json spectra_object(const ReportHistory& history, double begin, double cycle, double nominal, double highest);

/// The bytes of little-endian numbers as base64 text.
std::string base64(const void* data, std::size_t bytes);
template <class T>
std::string base64(const std::vector<T>& values) {
  return base64(values.data(), values.size() * sizeof(T));
}

}  // namespace drev::app
