#include "solvers/cycle_decay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drev {

namespace {

constexpr double kForgotten = 0.9;  // part of the largest size so far that still counts a cycle later
constexpr int kFewestSeen = 4;      // cycles seen at least

int half_window(int k) { return std::max(kFewestSeen, 2 * k); }

double size_of(const Vector& x) { return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0.0; }

}  // namespace

double CycleDecay::Repetition::left(double change) const {
  const double q = std::pow(ratio, cycles);
  return change / (1.0 - q);
}

void CycleDecay::add(const Vector& z, const Vector& v) {
  z_size_ = std::max(kForgotten * z_size_, size_of(z));
  v_size_ = std::max(kForgotten * v_size_, size_of(v));
  Distances distances;
  distances.fill(std::numeric_limits<double>::infinity());
  const auto beside = [](double distance, double size) { return size > 0.0 ? distance / size : 0.0; };
  for (std::size_t k = 0; k < std::min(ends_.size(), distances.size()); ++k)
    distances[k] =
        std::max(beside(size_of(z - ends_[k].z), z_size_), beside(size_of(v - ends_[k].v), v_size_));
  ends_.push_front({z, v});
  if (ends_.size() > static_cast<std::size_t>(kMostCycles)) ends_.pop_back();
  distances_.push_front(distances);
  if (distances_.size() > static_cast<std::size_t>(2 * half_window(kMostCycles))) distances_.pop_back();
}

double CycleDecay::largest(int k, int back, int count) const {
  double most = 0.0;
  for (int i = back; i < back + count; ++i) {
    if (i >= static_cast<int>(distances_.size())) return std::numeric_limits<double>::infinity();
    most = std::max(most, distances_[static_cast<std::size_t>(i)][static_cast<std::size_t>(k - 1)]);
  }
  return most;
}

std::optional<CycleDecay::Repetition> CycleDecay::repeats_in(int k) const {
  const int window = half_window(k);
  const double now = largest(k, 0, window);
  if (!(now <= kRepeats)) return std::nullopt;
  if (now <= kRounding) return Repetition{k, 0.0, now};
  const double before = largest(k, window, window);
  const double ratio = std::isfinite(before) ? std::pow(now / before, 1.0 / window) : 0.0;
  if (!std::isfinite(before) || !(ratio < 1.0)) return std::nullopt;
  const double step = std::pow(ratio, k), rest = now * step / (1.0 - step);
  if (!(rest <= kRepeats)) return std::nullopt;
  return Repetition{k, ratio, rest};
}

std::optional<CycleDecay::Repetition> CycleDecay::repeats() const {
  for (int k = 1; k <= kMostCycles; ++k)
    if (const auto found = repeats_in(k)) {
      for (int j = 1; j < k; ++j)
        if (k % j == 0 && largest(j, 0, half_window(j)) <= kNear) return std::nullopt;
      return found;
    }
  return std::nullopt;
}

}  // namespace drev
