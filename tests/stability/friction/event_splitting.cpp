// integrate(): the motion of a train with dry friction by a code of its own.
#include <algorithm>
#include <cmath>

#include "tests/stability/friction/gear_equations.hpp"

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
        gears_(train.gears.size()),
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
    // Unknown torques, each with the accelerations that it makes; conditions on accelerations and torques.
    const std::size_t m = stuck.size() + 2 * gears_.size();
    if (m == 0) return true;
    std::vector<std::vector<double>> makes(m, std::vector<double>(n_)), w(m, std::vector<double>(m + 1));
    for (std::size_t r = 0; r < stuck.size(); ++r) apply(train_.contacts[stuck[r]], 1.0, makes[r]);
    for (std::size_t g = 0; g < gears_.size(); ++g) {
      const TrainGear& gear = train_.gears[g];
      makes[stuck.size() + 2 * g][static_cast<std::size_t>(gear.a)] = -1.0;
      makes[stuck.size() + 2 * g + 1][static_cast<std::size_t>(gear.b)] = 1.0 / gear.ratio;
    }
    for (std::vector<double>& of : makes)
      for (std::size_t i = 0; i < n_; ++i) of[i] /= train_.inertia[i];
    for (std::size_t r = 0; r < stuck.size(); ++r) {
      for (std::size_t s = 0; s < m; ++s) w[r][s] = slip(train_.contacts[stuck[r]], makes[s]);
      w[r][m] = -slip(train_.contacts[stuck[r]], a);
    }
    for (std::size_t g = 0; g < gears_.size(); ++g) {
      const TrainGear& gear = train_.gears[g];
      const std::size_t r = stuck.size() + 2 * g, in = r, out = r + 1;
      const auto ea = static_cast<std::size_t>(gear.a), eb = static_cast<std::size_t>(gear.b);
      for (std::size_t s = 0; s < m; ++s) w[r][s] = makes[s][eb] - gear.ratio * makes[s][ea];
      w[r][m] = gear.ratio * a[ea] - a[eb];
      const GearMode& mode = gears_[g];
      if (mode.turns == 0) {
        for (std::size_t s = 0; s < m; ++s) w[r + 1][s] = makes[s][ea];
        w[r + 1][m] = -a[ea];
        continue;
      }
      const TrainGear::Loss loss = loss_at(gear, p.speed[ea]);
      if (mode.drives == 0) {
        w[r + 1][out] = 1.0, w[r + 1][in] = -loss.forward;
        w[r + 1][m] = -mode.turns * loss.bearing_forward;
      } else {
        w[r + 1][in] = 1.0, w[r + 1][out] = -loss.backward;
        w[r + 1][m] = mode.turns * loss.backward * loss.bearing_backward;
      }
    }
    if (!eliminate(w)) return false;
    in_.resize(gears_.size());
    out_.resize(gears_.size());
    for (std::size_t k = 0; k < m; ++k) {
      const double x = w[k][m] / w[k][k];
      if (k < stuck.size())
        torque[stuck[k]] = x;
      else
        ((k - stuck.size()) % 2 == 0 ? in_ : out_)[(k - stuck.size()) / 2] = x;
      for (std::size_t i = 0; i < n_; ++i) a[i] += x * makes[k][i];
    }
    return true;
  }

  double speed_of(const TrainGear& g, const std::vector<double>& speed) const {
    return speed[static_cast<std::size_t>(g.a)];
  }
  /// By how much a gear's condition on its torques (of the last evaluate()) is broken, > 0.
  double gear_broken(std::size_t g, double speed) const {
    const TrainGear::Loss loss = loss_at(train_.gears[g], speed);
    const GearMode& mode = gears_[g];
    const auto asked = [&](int turns, int drives) { return asks(loss, turns, drives, out_[g]); };
    if (mode.turns == 0)
      return std::max(in_[g] - std::max(asked(1, 0), asked(1, 1)),
                      std::min(asked(-1, 0), asked(-1, 1)) - in_[g]);
    return mode.turns * (asked(mode.turns, 1 - mode.drives) - in_[g]);
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

  /// By how much a contact's or spring's condition is broken, > 0; numbered contacts first, then springs,
  /// then gears.
  double broken(std::size_t i, const TrainPoint& p, const std::vector<double>& torque) const {
    if (i >= m_ + side_.size()) {
      const std::size_t g = i - m_ - side_.size();
      const GearMode& mode = gears_[g];
      const double w = speed_of(train_.gears[g], p.speed), knot = train_.gears[g].knot_speed;
      double wrong = gear_broken(g, w);
      if (mode.turns != 0 && !mode.rests) wrong = std::max(wrong, -mode.turns * w);
      if (knot > 0.0 && mode.turns != 0)
        wrong = std::max(wrong, (std::abs(w) - knot) * (mode.beyond ? -1.0 : 1.0));
      return wrong;
    }
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
    const int gear = who - static_cast<int>(m_ + side_.size());  // >= 0: of a gear
    const GearMode gear_was = gear >= 0 ? gears_[static_cast<std::size_t>(gear)] : GearMode{};
    const bool gear_stops =
        gear >= 0 &&
        gear_was.turns * speed_of(train_.gears[static_cast<std::size_t>(gear)], now_.speed) < 0.0;
    const bool releases =
        who >= 0 && gear < 0 && modes_[static_cast<std::size_t>(who)] == ContactMode::stuck && started_;
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
    for (std::size_t g = 0; g < gears_.size(); ++g) {
      const double w = speed_of(train_.gears[g], now_.speed);
      GearMode& mode = gears_[g];
      const bool rests = std::abs(w) < kRestSpeed || (started_ && mode.turns == 0) ||
                         (static_cast<int>(g) == gear && gear_stops);
      mode = {rests ? 0 : w > 0.0 ? 1 : -1, 0, rests, !rests && std::abs(w) > train_.gears[g].knot_speed};
    }
    started_ = true;
    const std::vector<ContactMode> before = modes_;
    const std::vector<GearMode> gears_before = gears_;
    std::vector<GearMode> chosen_gears = gears_;
    std::size_t combinations = 1;
    for (std::size_t k = 0; k < at_rest.size(); ++k) combinations *= 3;
    for (const GearMode& g : gears_before) combinations *= g.rests ? 5 : 2;
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
      for (std::size_t g = 0; g < gears_.size(); ++g) {
        gears_[g] = gears_before[g];
        const std::size_t options = gears_before[g].rests ? 5 : 2, option = rest % options;
        rest /= options;
        gears_[g].drives = static_cast<int>(option % 2);
        if (gears_before[g].rests) gears_[g].turns = option == 4 ? 0 : option < 2 ? 1 : -1;
        gears_[g].rests = false;
        stuck += gears_[g].turns == 0;
        if (static_cast<int>(g) != gear || gear_stops) continue;
        // It lets go, or its other shaft drives.
        allowed =
            allowed && (gear_was.turns == 0 ? gears_[g].turns != 0 : gears_[g].drives != gear_was.drives);
      }
      if (!allowed) continue;
      std::fill(resting_.begin(), resting_.end(), 0);
      const double wrong = violation(at_rest, gears_before);
      const bool better = wrong < kTrialNoise ? best >= kTrialNoise || stuck > most_stuck : wrong < best;
      if (!better) continue;
      best = wrong;
      most_stuck = stuck;
      chosen = modes_;
      chosen_resting = resting_;
      chosen_gears = gears_;
    }
    modes_ = chosen;
    gears_ = chosen_gears;
    resting_ = chosen_resting;
    for (const std::size_t i : at_rest) {
      events_ += modes_[i] != before[i];
      if (modes_[i] != ContactMode::stuck) continue;
    }
    for (std::size_t g = 0; g < gears_.size(); ++g) events_ += gears_before[g].rests && gears_[g].turns != 0;
    hold();
  }

  /// Largest broken condition over a trial step, relative to torques and speed changes there.
  double violation(const std::vector<std::size_t>& at_rest, const std::vector<GearMode>& gears_before) {
    std::vector<double> a, torque;
    if (!evaluate(now_, a, torque)) return 1e299;
    double size = 1.0, wrong = 0.0;
    for (std::size_t i = 0; i < m_; ++i) size = std::max(size, std::abs(torque[i]));
    for (std::size_t g = 0; g < gears_.size(); ++g) {
      size = std::max({size, std::abs(in_[g]), std::abs(out_[g])});
      wrong = std::max(wrong, gear_broken(g, speed_of(train_.gears[g], now_.speed)) / size);
    }
    const TrainPoint end = stepped(now_, kTrialTime);
    std::vector<double> torque_end;
    evaluate(end, a, torque_end);
    double scale = 0.0;
    for (std::size_t k = 0; k < n_; ++k) scale = std::max(scale, kTrialTime * size / train_.inertia[k]);
    for (std::size_t g = 0; g < gears_.size(); ++g) {
      const TrainGear& gear = train_.gears[g];
      wrong = std::max(wrong, gear_broken(g, speed_of(gear, end.speed)) / size);
      if (!gears_before[g].rests || gears_[g].turns == 0) continue;
      const double w = speed_of(gear, end.speed) - speed_of(gear, now_.speed);
      wrong = std::max(wrong, -gears_[g].turns * w / scale);
      gears_[g].rests = std::abs(w) < 1e-11 * scale;
    }
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
      wrong = std::max(wrong, -along / scale);
      resting_[i] = std::abs(w) < 1e-11 * scale / kTrialTime * kTrialTime;
    }
    return wrong;
  }

  /// Slip of the stuck contacts to zero, at constant momentum.
  void hold() {
    const auto turn_back = [this](const std::vector<double>& row) {
      double w = 0.0, size = 0.0;
      for (std::size_t k = 0; k < n_; ++k) {
        w += row[k] * now_.speed[k];
        size += row[k] * row[k] / train_.inertia[k];
      }
      for (std::size_t k = 0; k < n_; ++k) now_.speed[k] -= w / size * row[k] / train_.inertia[k];
    };
    for (int pass = 0; pass < (gears_.empty() ? 50 : 400); ++pass) {
      for (std::size_t g = 0; g < gears_.size(); ++g) {
        std::vector<double> row(n_, 0.0);
        row[static_cast<std::size_t>(train_.gears[g].a)] = 1.0;
        if (gears_[g].turns == 0) turn_back(row);
        row[static_cast<std::size_t>(train_.gears[g].b)] = -1.0 / train_.gears[g].ratio;
        turn_back(row);
      }
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
  }

  void advance(double stop) {
    const double h = std::min(step_, stop - now_.t);
    std::vector<double> a, torque;
    const auto worst = [&](const TrainPoint& p) {
      int who = -1;
      evaluate(p, a, torque);
      for (std::size_t i = 0; i < m_ + side_.size() + gears_.size(); ++i)
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
    if (who >= static_cast<int>(m_ + side_.size()))
      return pass_gear(static_cast<std::size_t>(who) - m_ - side_.size(), who);
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

  void pass_gear(std::size_t g, int who) {
    GearMode& mode = gears_[g];
    const double w = speed_of(train_.gears[g], now_.speed), knot = train_.gears[g].knot_speed;
    std::vector<double> a, torque;
    evaluate(now_, a, torque);
    if (mode.turns != 0 && knot > 0.0 && std::abs(std::abs(w) - knot) < 1e-6 && gear_broken(g, w) <= 1e-12) {
      mode.beyond = !mode.beyond;
      return;
    }
    choose(who);
  }

  const FrictionTrain& train_;
  std::size_t n_, m_;
  double step_;
  TrainPoint now_;
  std::vector<ContactMode> modes_;
  std::vector<GearMode> gears_;
  mutable std::vector<double> in_, out_;  // torques of the gears, of the last evaluate()
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
