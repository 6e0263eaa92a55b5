/// Amplitudes of sampled tones with known answer.
#include <drev/core/error.hpp>
#include <drev/core/units.hpp>
#include <drev/solvers/periodic/spectrum.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/catch.hpp"

using namespace drev;

namespace {

std::vector<double> tone(int samples, double dt, double amplitude, double frequency, double phase) {
  std::vector<double> s;
  for (int j = 0; j < samples; ++j) s.push_back(amplitude * std::sin(kTwoPi * frequency * j * dt + phase));
  return s;
}

double largest(const Spectrum& s) { return *std::max_element(s.amplitude.begin(), s.amplitude.end()); }

constexpr Window kWindows[] = {Window::rectangular, Window::hann, Window::hamming, Window::flat_top};

}  // namespace

TEST_CASE("A tone on a line shows its amplitude with every window", "[spectrum]") {
  for (const Window window : kWindows) {
    const Spectrum s =
        spectrum(tone(1024, 1e-3, 3.5, 40 / 1.024, 0.7), 1e-3, {.window = window, .drop_end_point = false});
    REQUIRE(s.amplitude.size() == 513);
    CHECK(s.frequency_Hz[40] == Approx(39.0625));
    CHECK(s.frequency_Hz.back() == Approx(500.0));
    // a sum of 1024 roundings of 1e-16
    CHECK(s.amplitude[40] == Approx(3.5).epsilon(1e-13));
    CHECK(s.phase[40] == Approx(0.7 - kPi / 2).epsilon(1e-12));
    CHECK(s.amplitude[60] < 1e-13);
  }
}

TEST_CASE("A constant and the Nyquist line are not doubled", "[spectrum]") {
  for (const Window window : kWindows) {
    const Spectrum s =
        spectrum(std::vector<double>(64, -2.0), 0.1, {.window = window, .drop_end_point = false});
    CHECK(s.amplitude[0] == Approx(2.0).epsilon(1e-14));
  }
  // amplitude = |cos phase|: 1, 0.7071, 0
  for (const double phase : {0.0, kPi / 4, kPi / 2}) {
    std::vector<double> s;
    for (int j = 0; j < 64; ++j) s.push_back(std::cos(kPi * j + phase));
    CHECK(spectrum(s, 1e-3, {.drop_end_point = false}).amplitude.back() ==
          Approx(std::abs(std::cos(phase))).margin(1e-13));
  }
}

TEST_CASE("A tone half way between two lines loses what the window says", "[spectrum]") {
  // Window theory for N = 1024, computed independently to 12 digits. It leaves out the tone's image
  // at negative frequency, 200.5 lines away: up to 1/(N sin(200.5 pi/N)) = 1.69e-3 with the
  // rectangular window, 0.16 of that with Hamming's, whose edge stands at 0.16 of its mean.
  const double expected[] = {.636620022039, .848826363157, .817388288534, .998874893745};
  const double tolerance[] = {1.7e-3, 1e-6, 2.8e-4, 1e-5};
  const double at_20_lines[] = {1.7e-2, 3.7e-5, 2.5e-3, 2.5e-5};
  for (int w = 0; w < 4; ++w) {
    const Spectrum s = spectrum(tone(1024, 1.0, 1.0, 100.5 / 1024, 0.3), 1.0,
                                {.window = kWindows[w], .drop_end_point = false});
    CHECK(largest(s) == Approx(expected[w]).margin(tolerance[w]));
    CHECK(s.amplitude[121] < 1.5 * at_20_lines[w]);
  }
}

TEST_CASE("Whole periods leak nothing, unless the end point is there twice", "[spectrum]") {
  const std::vector<double> both_ends = tone(201, 0.01, 1.0, 5.0, 0.3);  // 10 periods, 200 intervals
  const auto leak = [](const Spectrum& s) {
    double sum = 0.0;
    for (std::size_t k = 0; k < s.amplitude.size(); ++k)
      if (k != 10) sum = std::max(sum, s.amplitude[k]);
    return sum;
  };
  const Spectrum right = spectrum(both_ends, 0.01);
  CHECK(right.frequency_Hz[10] == Approx(5.0).epsilon(1e-15));
  CHECK(right.amplitude[10] == Approx(1.0).epsilon(1e-13));
  CHECK(leak(right) < 1e-13);
  // 10.05 periods on 201 samples: the nearest line is 0.05 off; sinc leaks 0.05 / 1.05 into the
  // next
  const Spectrum wrong = spectrum(both_ends, 0.01, {.drop_end_point = false});
  CHECK(leak(wrong) > 0.02);
}

TEST_CASE("The mean is removed on demand", "[spectrum]") {
  std::vector<double> s = tone(400, 0.01, 0.1, 1.0, 0.0);
  for (double& x : s) x += 1000.0;
  const SpectrumOptions options{.window = Window::hann, .drop_end_point = false, .remove_mean = true};
  const Spectrum result = spectrum(s, 0.01, options);
  CHECK(result.amplitude[0] < 1e-10);
  CHECK(result.amplitude[4] == Approx(0.1).epsilon(1e-9));
}

TEST_CASE("Odd number of samples", "[spectrum]") {
  const Spectrum s = spectrum(tone(105, 0.01, 2.0, 7 / 1.05, 0.0), 0.01, {.drop_end_point = false});
  CHECK(s.amplitude.size() == 53);
  CHECK(s.amplitude[7] == Approx(2.0).epsilon(1e-13));
  CHECK(s.amplitude.back() < 1e-13);
}

TEST_CASE("Peaks are interpolated and sorted by amplitude", "[spectrum]") {
  const double dt = 1e-3;
  for (const Window window : {Window::hann, Window::hamming, Window::flat_top})
    for (const double fraction : {0.0, 0.2, 0.5, 0.8}) {
      const double step = 1.0 / 2.048, f_1 = (60 + fraction) * step, f_2 = (200 + fraction) * step;
      std::vector<double> s = tone(2048, dt, 1.0, f_1, 0.4);
      const std::vector<double> second = tone(2048, dt, 3.0, f_2, 1.1);
      for (std::size_t j = 0; j < s.size(); ++j) s[j] += second[j];
      const auto peaks =
          spectrum_peaks(spectrum(s, dt, {.window = window, .drop_end_point = false}), 2, 10 * step);
      REQUIRE(peaks.size() == 2);
      // what the other tone and the images leak, 120 lines away and more: 0.16/(120 pi) with
      // Hamming
      CHECK(std::abs(peaks[0].frequency_Hz - f_2) < 4e-3 * step);
      CHECK(std::abs(peaks[1].frequency_Hz - f_1) < 4e-3 * step);
      CHECK(peaks[0].amplitude == Approx(3.0).epsilon(4e-3));
      CHECK(peaks[1].amplitude == Approx(1.0).epsilon(4e-3));
    }
}

TEST_CASE("Separation and number of peaks", "[spectrum]") {
  std::vector<double> s = tone(1000, 1e-3, 1.0, 100.0, 0.0);
  const std::vector<double> near = tone(1000, 1e-3, 0.8, 110.0, 0.0);
  const std::vector<double> far = tone(1000, 1e-3, 0.5, 300.0, 0.0);
  for (std::size_t j = 0; j < s.size(); ++j) s[j] += near[j] + far[j];
  const Spectrum sp = spectrum(s, 1e-3, {.drop_end_point = false});
  CHECK(spectrum_peaks(sp, 2)[1].frequency_Hz == Approx(110.0).epsilon(1e-3));
  CHECK(spectrum_peaks(sp, 2, 20.0)[1].frequency_Hz == Approx(300.0).epsilon(1e-3));
  CHECK(spectrum_peaks(sp, 1).size() == 1);
  CHECK_THROWS_AS(spectrum_peaks(sp, 0), ModelError);
  CHECK_THROWS_AS(spectrum_peaks(sp, 1, -1.0), ModelError);
}

TEST_CASE("Records that cannot be transformed are refused", "[spectrum]") {
  const std::vector<double> good(8, 1.0);
  CHECK_THROWS_AS(spectrum({}, 0.1), ModelError);
  CHECK_THROWS_AS(spectrum({1, 2, 3}, 0.1, {.drop_end_point = false}), ModelError);
  CHECK_THROWS_AS(spectrum({1, 2, 3, 4}, 0.1), ModelError);
  CHECK_NOTHROW(spectrum({1, 2, 3, 4, 5}, 0.1));
  CHECK_THROWS_AS(spectrum(good, 0.0), ModelError);
  CHECK_THROWS_AS(spectrum(good, -1.0), ModelError);
  CHECK_THROWS_AS(spectrum(good, std::numeric_limits<double>::infinity()), ModelError);
  std::vector<double> bad = good;
  bad[2] = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(spectrum(bad, 0.1), ModelError);
}
