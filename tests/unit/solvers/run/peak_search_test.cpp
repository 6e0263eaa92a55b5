// Extremes found on a function itself, with and without its rate.
#include "solvers/run/peak_search.hpp"

#include <cmath>

#include "tests/catch.hpp"

using namespace drev;

namespace {

/// Searches y over [0, 1] in `parts`; counts its calls.
template <class F, class Rate>
std::pair<Peak, int> searched(const F& y, const Rate& rate, bool with_rate, int parts) {
  int looks = 0;
  const auto sample = [&](double t) -> PeakSample {
    return {t, y(t), with_rate ? std::optional<double>(rate(t)) : std::nullopt};
  };
  const auto look = [&](double t) {
    ++looks;
    return sample(t);
  };
  Peak peak{{y(0.0), 0.0, y(0.0), 0.0}};
  for (int i = 0; i < parts; ++i) {
    const PeakSample a = sample(static_cast<double>(i) / parts), b = sample((i + 1.0) / parts);
    peak.note(b.y, b.t);
    search_peak(a, b, look, peak.max - peak.min, peak);
  }
  return {peak, looks};
}

}  // namespace

TEST_CASE("Peak search: maximum and minimum of a sine to rounding, in few looks") {
  const auto y = [](double t) { return 3.0 + std::sin(9.0 * t + 0.2); };
  const auto rate = [](double t) { return 9.0 * std::cos(9.0 * t + 0.2); };
  for (const bool with_rate : {true, false}) {
    const auto [peak, looks] = searched(y, rate, with_rate, 30);
    CHECK(peak.max == Approx(4.0).epsilon(1e-14));
    CHECK(peak.min == Approx(2.0).epsilon(1e-14));
    CHECK(peak.max_time == Approx((1.5707963267948966 - 0.2) / 9.0).epsilon(1e-6));
    CHECK(looks < (with_rate ? 40 : 250));
  }
}

TEST_CASE("Peak search: a kink between two samples of one height, without a rate") {
  const auto y = [](double t) { return 1.0 - std::abs(t - 0.437); };
  const auto none = [](double) { return 0.0; };
  CHECK(searched(y, none, false, 10).first.max == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("Peak search: a maximum just inside an end of an interval, or of the first one") {
  // Skewed, so that the parabola through three points puts its vertex outside.
  for (const double end : {0.0, 0.5})
    for (const double skew : {-0.9, 0.9})
      for (const double ahead : {1e-2, 1e-3, 1e-4, 1e-5, -1e-3, -1e-5}) {
        const double top = end + ahead;
        if (top < 0.0) continue;
        const auto y = [&](double t) { return 2.0 - (t - top) * (t - top) * (1.0 + skew * (t - top)); };
        const auto rate = [&](double t) { return -(t - top) * (2.0 + 3.0 * skew * (t - top)); };
        for (const bool with_rate : {true, false}) {
          INFO("maximum at " << top << ", skew " << skew << (with_rate ? ", with rate" : ", without"));
          CHECK(searched(y, rate, with_rate, 2).first.max == Approx(2.0).epsilon(1e-15));
        }
      }
}

TEST_CASE("Peak search: a constant takes one look where it has no rate") {
  const auto y = [](double t) { return 3.0 + 4e-16 * std::sin(1e3 * t); };
  const auto none = [](double) { return 0.0; };
  CHECK(searched(y, none, false, 10).second <= 10);
}
