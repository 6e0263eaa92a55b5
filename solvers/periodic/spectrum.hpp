#pragma once
/// One-sided amplitude spectrum of a record with equal steps:
///
///   A_k = c |sum_j w_j s_j exp(-2 pi i j k / N)| / sum_j w_j,  f_k = k / (N dt)
///
/// c = 2, at zero frequency and (N even) at the Nyquist frequency 1. A sin(2 pi f t) shows A where
/// f is one of f_k, with every window. Between them the largest A_k is too small by up to 36.3 %
/// (rectangular), 15.1 % (Hann), 18.3 % (Hamming), 0.11 % (flat top). A tone at the Nyquist
/// frequency shows A |cos phase|.
///
/// A record of whole periods needs no window (rectangular leaks nothing) but must not hold the end
/// of its period twice: N intervals of dt have N + 1 ends, of which the last repeats the first.
/// drop_end_point leaves it out and is set unless told otherwise, since solvers record both ends.
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
  std::vector<double> amplitude;     ///< unit of the samples
  std::vector<double>
      phase;  ///< rad, of a cosine, at the first sample; noise where the amplitude is rounding
  Window window = Window::rectangular;
};

/// samples: at least 4 that are used, finite. dt: s, > 0. Throws ModelError otherwise.
Spectrum spectrum(const std::vector<double>& samples, double dt, const SpectrumOptions& options = {});

/// A local maximum of a spectrum.
struct SpectrumPeak {
  double frequency_Hz = 0.0;
  double amplitude = 0.0;
};

/// The count largest local maxima, by amplitude, descending; none nearer to a larger one than
/// min_separation_Hz. Frequency and amplitude are those of the one tone that, with the spectrum's
/// window, shows the largest line and its larger neighbour as they are. Exact for a tone alone in a
/// long record; what other tones leak there (with the rectangular window about 1 / (pi distance in
/// lines)) is the error. Lines at zero and Nyquist frequency are no peaks. Throws ModelError for
/// count < 1 or min_separation_Hz < 0.
std::vector<SpectrumPeak> spectrum_peaks(const Spectrum& spectrum, int count, double min_separation_Hz = 0.0);

}  // namespace drev
