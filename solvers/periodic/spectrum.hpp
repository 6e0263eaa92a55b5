#pragma once
/// One-sided amplitude spectrum of a record with equal steps:
///
///   A_k = c |sum_j w_j s_j exp(-2 pi i j k / N)| / sum_j w_j,  f_k = k / (N dt)
///
/// c = 2, but 1 at zero frequency and, for even N, at the Nyquist frequency. A sin(2 pi f t) shows A where
/// f is one of f_k, with every window. Between them the largest A_k is too small by up to 36.3 %
/// (rectangular), 15.1 % (Hann), 18.3 % (Hamming), 0.11 % (flat top). A tone at the Nyquist
/// frequency shows A |cos phase|.
///
/// A record of whole periods needs no window (rectangular leaks nothing) but must not hold the end
/// of its period twice: N intervals of dt have N + 1 ends, of which the last repeats the first.
/// drop_end_point leaves the last one out; it is true by default, since solvers record both ends.
///
/// Source: G. Heinzel, A. Ruediger, R. Schilling, Spectrum and spectral density estimation by the
/// DFT, Max-Planck-Institut fuer Gravitationsphysik, 2002; flat top: SciPy's signal.windows.flattop
/// coefficients (G. D'Antona, A. Ferrero, Digital Signal Processing for Measurement Systems,
/// Springer, 2006, p. 70).
#include <vector>

namespace drev {

enum class Window { rectangular, hann, hamming, flat_top };

struct SpectrumOptions {
  Window window = Window::rectangular;
  /// True: the record holds both ends of its duration, N + 1 samples of N intervals; the last is
  /// left out. False: all samples are used and the record is taken to repeat one step after the
  /// last.
  bool drop_end_point = true;
  /// True: the mean is subtracted before windowing, so that it does not leak into the lowest lines.
  bool remove_mean = false;
};

struct Spectrum {
  std::vector<double> frequency_Hz;  ///< 0 to Nyquist, step 1 / (N dt)
  std::vector<double> amplitude;     ///< amplitude of each line, in the unit of the samples
  /// Phase of a cosine at the first sample [rad]; noise where the amplitude is rounding.
  std::vector<double> phase;
  Window window = Window::rectangular;
};

/// samples: finite, at least 4 that are used. dt: time between samples [s], > 0. Throws ModelError otherwise.
Spectrum spectrum(const std::vector<double>& samples, double dt, const SpectrumOptions& options = {});

/// A local maximum of a spectrum.
struct SpectrumPeak {
  double frequency_Hz = 0.0;
  double amplitude = 0.0;
};

/// The largest local maxima, `count` of them, by descending amplitude; none nearer to a larger one than
/// min_separation_Hz. Frequency and amplitude are those of the one tone that, with the spectrum's
/// window, would give the peak's line and its larger neighbour. They are exact for a single tone in a
/// long record; the error is the leakage of other tones (with the rectangular window about
/// 1 / (pi distance in lines)). Lines at zero and Nyquist frequency are no peaks. Throws ModelError for
/// count < 1 or min_separation_Hz < 0.
std::vector<SpectrumPeak> spectrum_peaks(const Spectrum& spectrum, int count, double min_separation_Hz = 0.0);

}  // namespace drev
