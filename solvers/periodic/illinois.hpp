#pragma once
/// IllinoisBracket: a root of f between two places at which f has different signs.
///
///   x = (low f_high - high f_low) / (f_high - f_low)
///
/// takes the place of the end with its sign; the f of an end that stays twice in a row is halved, so that both ends close in.
/// Source: M. Dowell, P. Jarratt, A modified regula falsi method for computing the root of an equation, BIT 11, 1971.
namespace drev {

struct IllinoisBracket {
  double low = 0.0, f_low = 0.0;  ///< f_low is not 0
  double high = 0.0, f_high = 0.0;
  int stayed = 0;  ///< 1: low has stayed, -1: high has, 0: neither yet

  double next() const { return (low * f_high - high * f_low) / (f_high - f_low); }
  void take(double x, double f) {
    const int stays = (f > 0.0) == (f_low > 0.0) ? -1 : 1;
    (stays < 0 ? low : high) = x;
    (stays < 0 ? f_low : f_high) = f;
    if (stays == stayed) (stays < 0 ? f_high : f_low) *= 0.5;
    stayed = stays;
  }
};

}  // namespace drev
