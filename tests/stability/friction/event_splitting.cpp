// integrate(): the motion of a train with dry friction by a code of its own.
#include <algorithm>
#include <cmath>

#include "tests/stability/friction/friction_train.hpp"

namespace drev::test {

namespace {

using TrainContact = FrictionTrain::Contact;
constexpr double kPi2 = 6.283185307179586;
constexpr double kTrialTime = 1e-6;   // s, over which combinations are tried
constexpr double kRestSpeed = 1e-9;   // rad/s
constexpr double kTrialNoise = 1e-7;  // of a torque or speed change, in a trial

enum class ContactMode { stuck, forward, backward, open };

struct TrainPoint {
  double t = 0.0;
  std::vector<double> angle, speed;
};

class EventSplitting {
 public:
  EventSplitting(const FrictionTrain& train, double step)
      : train_(train),
        n_(train.inertia.size()),
        m_(train.contacts.size()),
        step_(step),
        modes_(m_),
        side_(train.springs.size()) {
    now_ = {0.0, train.angle, train.speed};
    for (const TrainContact& c : train.contacts)
      for (const double t : c.times)
        if (t > 0.0 && t < train.duration) stops_.push_back(t);
    stops_.push_back(train.duration);
    std::sort(stops_.begin(), stops_.end());
  }

  FrictionMotion run() {
    for (const double stop : stops_) {
      find_sides();
      choose(-1);
      while (now_.t < stop) advance(stop);
      now_.t = stop;
    }
    return {now_.angle, now_.speed, events_};
  }

 private:
  double part(const TrainContact& c, double t) const {
    if (c.times.empty()) return 1.0;
    // Inside a stretch: its own straight line, at both its ends.
    const double inside = 0.5 * (now_.t + std::min(next_stop(), now_.t + step_));
    if (inside <= c.times.front()) return c.parts.front();
    for (std::size_t i = 0; i + 1 < c.times.size(); ++i)
      if (inside >= c.times[i] && inside < c.times[i + 1])
        return c.parts[i] + (c.parts[i + 1] - c.parts[i]) * (t - c.times[i]) / (c.times[i + 1] - c.times[i]);
    return c.parts.back();
  }
  double next_stop() const { return *std::upper_bound(stops_.begin(), stops_.end() - 1, now_.t); }
  double slip(const TrainContact& c, const std::vector<double>& speed) const {
    return c.b < 0 ? speed[static_cast<std::size_t>(c.a)]
                   : speed[static_cast<std::size_t>(c.b)] - speed[static_cast<std::size_t>(c.a)];
  }
  double sliding(const TrainContact& c, double w) const {
    if (c.kind == TrainContact::Kind::freewheel) return 0.0;
    if (c.knot_speed == 0.0) return c.torque;
    return c.torque + (c.far_torque - c.torque) * std::min(1.0, std::abs(w) / c.knot_speed);
  }
  void apply(const TrainContact& c, double torque, std::vector<double>& force) const {
    if (c.b < 0) {
      force[static_cast<std::size_t>(c.a)] -= torque;
    } else {
      force[static_cast<std::size_t>(c.b)] -= torque;
      force[static_cast<std::size_t>(c.a)] += torque;
    }
  }

  /// Accelerations and torques of the contacts; false: the stuck ones depend on each other.
  bool evaluate(const TrainPoint& p, std::vector<double>& a, std::vector<double>& torque) const {
    std::vector<double> force(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      const FrictionTrain::Drive& d = train_.drives[i];
      force[i] = d.mean + d.amplitude * std::cos(kPi2 * d.frequency_Hz * p.t);
    }
    for (std::size_t i = 0; i < side_.size(); ++i) {
      const FrictionTrain::Spring& s = train_.springs[i];
      const auto e = static_cast<std::size_t>(s.a), f = static_cast<std::size_t>(s.b);
      const double twist = p.angle[f] - p.angle[e], rate = p.speed[f] - p.speed[e];
      const double y = s.half_gap > 0.0
                           ? (side_[i] == 0 ? 0.0 : s.stiffness * (twist - side_[i] * s.half_gap))
                           : s.stiffness * twist + s.damping * rate;
      force[f] -= y;
      force[e] += y;
    }
    torque.assign(m_, 0.0);
    std::vector<std::size_t> stuck;
    for (std::size_t i = 0; i < m_; ++i) {
      const TrainContact& c = train_.contacts[i];
      if (modes_[i] == ContactMode::stuck) stuck.push_back(i);
      if (modes_[i] != ContactMode::forward && modes_[i] != ContactMode::backward) continue;
      torque[i] =
          (modes_[i] == ContactMode::forward ? 1.0 : -1.0) * part(c, p.t) * sliding(c, slip(c, p.speed));
      apply(c, torque[i], force);
    }
    a.resize(n_);
    for (std::size_t i = 0; i < n_; ++i) a[i] = force[i] / train_.inertia[i];
    // W lambda = slip accelerations, by elimination with pivots.
    const std::size_t m = stuck.size();
    std::vector<std::vector<double>> w(m, std::vector<double>(m + 1));
    for (std::size_t r = 0; r < m; ++r) {
      std::vector<double> unit(n_, 0.0);
      apply(train_.contacts[stuck[r]], -1.0, unit);
      for (std::size_t i = 0; i < n_; ++i) unit[i] /= train_.inertia[i];
      for (std::size_t s = 0; s < m; ++s) w[s][r] = slip(train_.contacts[stuck[s]], unit);
      w[r][m] = slip(train_.contacts[stuck[r]], a);
    }
    for (std::size_t k = 0; k < m; ++k) {
      std::size_t best = k;
      for (std::size_t r = k; r < m; ++r)
        if (std::abs(w[r][k]) > std::abs(w[best][k])) best = r;
      if (std::abs(w[best][k]) < 1e-9) return false;
      std::swap(w[k], w[best]);
      for (std::size_t r = 0; r < m; ++r) {
        if (r == k) continue;
        const double factor = w[r][k] / w[k][k];
        for (std::size_t s = k; s <= m; ++s) w[r][s] -= factor * w[k][s];
      }
    }
    for (std::size_t k = 0; k < m; ++k) {
      torque[stuck[k]] = w[k][m] / w[k][k];
      std::vector<double> own(n_, 0.0);
      apply(train_.contacts[stuck[k]], torque[stuck[k]], own);
      for (std::size_t i = 0; i < n_; ++i) a[i] += own[i] / train_.inertia[i];
    }
    return true;
  }

  TrainPoint stepped(const TrainPoint& from, double h) const {
    std::vector<double> a[4], torque;
    TrainPoint p = from;
    std::vector<double> v[4];
    const double at[4] = {0.0, 0.5 * h, 0.5 * h, h};
    for (int k = 0; k < 4; ++k) {
      if (k > 0) {
        p.t = from.t + at[k];
        for (std::size_t i = 0; i < n_; ++i) {
          p.angle[i] = from.angle[i] + at[k] * v[k - 1][i];
          p.speed[i] = from.speed[i] + at[k] * a[k - 1][i];
        }
      }
      v[k] = p.speed;
      evaluate(p, a[k], torque);
    }
    p.t = from.t + h;
    for (std::size_t i = 0; i < n_; ++i) {
      p.angle[i] = from.angle[i] + h / 6.0 * (v[0][i] + 2.0 * v[1][i] + 2.0 * v[2][i] + v[3][i]);
      p.speed[i] = from.speed[i] + h / 6.0 * (a[0][i] + 2.0 * a[1][i] + 2.0 * a[2][i] + a[3][i]);
    }
    return p;
  }

  struct TorqueBounds {
    double low, high;
  };
  TorqueBounds bounds(const TrainContact& c, double t) const {
    if (c.kind == TrainContact::Kind::freewheel) return {-1e300, 0.0};
    const double most = part(c, t) * c.torque * c.break_away;
    return {-most, most};
  }

  /// By how much a contact's or spring's condition is broken, > 0; numbered contacts first, then springs.
  double broken(std::size_t i, const TrainPoint& p, const std::vector<double>& torque) const {
    if (i >= m_) {
      const FrictionTrain::Spring& s = train_.springs[i - m_];
      if (s.half_gap == 0.0) return -1.0;
      const double twist = p.angle[static_cast<std::size_t>(s.b)] - p.angle[static_cast<std::size_t>(s.a)];
      if (side_[i - m_] == 0) return std::abs(twist) - s.half_gap;
      return s.half_gap - side_[i - m_] * twist;
    }
    const TrainContact& c = train_.contacts[i];
    if (modes_[i] == ContactMode::open) return -1.0;
    if (modes_[i] == ContactMode::stuck) {
      const TorqueBounds b = bounds(c, p.t);
      return std::max(torque[i] - b.high, b.low - torque[i]);
    }
    const double w = slip(c, p.speed);
    if (resting_[i]) return -1.0;  // carries its bound, held at rest by others
    const double past_knot =
        c.knot_speed > 0.0 ? (std::abs(w) - c.knot_speed) * (beyond_[i] ? -1.0 : 1.0) : -1.0;
    return std::max(modes_[i] == ContactMode::forward ? -w : w, past_knot);
  }

  void find_sides() {
    for (std::size_t i = 0; i < side_.size(); ++i) {
      const FrictionTrain::Spring& s = train_.springs[i];
      const double twist =
          now_.angle[static_cast<std::size_t>(s.b)] - now_.angle[static_cast<std::size_t>(s.a)];
      const double rate =
          now_.speed[static_cast<std::size_t>(s.b)] - now_.speed[static_cast<std::size_t>(s.a)];
      const double ahead = twist + 1e-9 * rate;
      side_[i] = ahead > s.half_gap ? 1 : ahead < -s.half_gap ? -1 : 0;
    }
  }

  /// Modes behind an event of contact `who` (-1: none): contacts that move keep theirs.
  void choose(int who) {
    const bool releases = who >= 0 && modes_[static_cast<std::size_t>(who)] == ContactMode::stuck && started_;
    std::vector<std::size_t> at_rest;
    resting_.assign(m_, 0);
    beyond_.resize(m_, 0);
    for (std::size_t i = 0; i < m_; ++i) {
      const TrainContact& c = train_.contacts[i];
      const double w = slip(c, now_.speed);
      const double middle = 0.5 * (now_.t + next_stop());
      if (part(c, now_.t) == 0.0 && part(c, middle) == 0.0) {
        modes_[i] = ContactMode::open;
        continue;
      }
      if (std::abs(w) < kRestSpeed || (started_ && modes_[i] == ContactMode::stuck) ||
          static_cast<int>(i) == who) {
        at_rest.push_back(i);
        beyond_[i] = 0;
        continue;
      }
      modes_[i] = w > 0.0 ? ContactMode::forward : ContactMode::backward;
      beyond_[i] = std::abs(w) > c.knot_speed;
    }
    started_ = true;
    const std::vector<ContactMode> before = modes_;
    std::size_t combinations = 1;
    for (std::size_t k = 0; k < at_rest.size(); ++k) combinations *= 3;
    double best = 1e300;
    int most_stuck = -1;
    std::vector<ContactMode> chosen = modes_;
    std::vector<char> chosen_resting = resting_;
    for (std::size_t code = 0; code < combinations; ++code) {
      std::size_t rest = code;
      int stuck = 0;
      bool allowed = true;
      for (const std::size_t i : at_rest) {
        modes_[i] = static_cast<ContactMode>(rest % 3);
        rest /= 3;
        stuck += modes_[i] == ContactMode::stuck;
        allowed =
            allowed && !(releases && static_cast<int>(i) == who && modes_[i] == ContactMode::stuck) &&
            !(train_.contacts[i].kind == TrainContact::Kind::freewheel && modes_[i] == ContactMode::backward);
      }
      if (!allowed) continue;
      std::fill(resting_.begin(), resting_.end(), 0);
      const double wrong = violation(at_rest);
      const bool better = wrong < kTrialNoise ? best >= kTrialNoise || stuck > most_stuck : wrong < best;
      if (!better) continue;
      best = wrong;
      most_stuck = stuck;
      chosen = modes_;
      chosen_resting = resting_;
    }
    modes_ = chosen;
    resting_ = chosen_resting;
    for (const std::size_t i : at_rest) {
      events_ += modes_[i] != before[i];
      if (modes_[i] != ContactMode::stuck) continue;
    }
    hold();
  }

  /// Largest broken condition over a trial step, relative to torques and speed changes there.
  double violation(const std::vector<std::size_t>& at_rest) {
    std::vector<double> a, torque;
    if (!evaluate(now_, a, torque)) return 1e299;
    double size = 1.0, wrong = 0.0;
    const TrainPoint end = stepped(now_, kTrialTime);
    std::vector<double> torque_end;
    evaluate(end, a, torque_end);
    for (std::size_t i = 0; i < m_; ++i) size = std::max(size, std::abs(torque[i]));
    for (const std::size_t i : at_rest) {
      const TrainContact& c = train_.contacts[i];
      if (modes_[i] == ContactMode::stuck) {
        const TorqueBounds b_0 = bounds(c, now_.t), b_1 = bounds(c, end.t);
        wrong = std::max({wrong, (torque[i] - b_0.high) / size, (b_0.low - torque[i]) / size,
                          (torque_end[i] - b_1.high) / size, (b_1.low - torque_end[i]) / size});
        continue;
      }
      const double w = slip(c, end.speed) - slip(c, now_.speed);
      const double along = modes_[i] == ContactMode::forward ? w : -w;
      double scale = 0.0;
      for (std::size_t k = 0; k < n_; ++k) scale = std::max(scale, kTrialTime * size / train_.inertia[k]);
      wrong = std::max(wrong, -along / scale);
      resting_[i] = std::abs(w) < 1e-11 * scale / kTrialTime * kTrialTime;
    }
    return wrong;
  }

  /// Slip of the stuck contacts to zero, at constant momentum.
  void hold() {
    for (int pass = 0; pass < 50; ++pass)
      for (std::size_t i = 0; i < m_; ++i) {
        if (modes_[i] != ContactMode::stuck) continue;
        const TrainContact& c = train_.contacts[i];
        std::vector<double> unit(n_, 0.0);
        apply(c, 1.0, unit);
        for (std::size_t k = 0; k < n_; ++k) unit[k] /= train_.inertia[k];
        const double factor = slip(c, now_.speed) / slip(c, unit);
        for (std::size_t k = 0; k < n_; ++k) now_.speed[k] -= factor * unit[k];
      }
  }

  void advance(double stop) {
    const double h = std::min(step_, stop - now_.t);
    std::vector<double> a, torque;
    const auto worst = [&](const TrainPoint& p) {
      int who = -1;
      evaluate(p, a, torque);
      for (std::size_t i = 0; i < m_ + side_.size(); ++i)
        if (broken(i, p, torque) > 1e-12) who = static_cast<int>(i);
      return who;
    };
    TrainPoint end = stepped(now_, h);
    int who = worst(end);
    if (who < 0) {
      now_ = end;
      return;
    }
    double good = 0.0, bad = h;
    for (int i = 0; i < 50 && bad - good > 1e-15; ++i) {
      const double middle = 0.5 * (good + bad);
      const int at = worst(stepped(now_, middle));
      if (at >= 0)
        who = at, bad = middle;
      else
        good = middle;
    }
    now_ = stepped(now_, bad);
    find_sides();
    if (who >= static_cast<int>(m_)) return;
    const auto k = static_cast<std::size_t>(who);
    const TrainContact& c = train_.contacts[k];
    const double w = slip(c, now_.speed);
    if (modes_[k] != ContactMode::stuck && c.knot_speed > 0.0 &&
        std::abs(std::abs(w) - c.knot_speed) < 1e-6) {
      beyond_[k] = !beyond_[k];
      return;
    }
    choose(who);
  }

  const FrictionTrain& train_;
  std::size_t n_, m_;
  double step_;
  TrainPoint now_;
  std::vector<ContactMode> modes_;
  std::vector<char> resting_, beyond_;
  std::vector<int> side_;
  std::vector<double> stops_;
  bool started_ = false;
  long events_ = 0;
};

}  // namespace

FrictionMotion integrate(const FrictionTrain& train, double step) {
  return EventSplitting(train, step).run();
}

}  // namespace drev::test
