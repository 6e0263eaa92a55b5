#pragma once
/// LawWork: energy of laws whose force is no linear function of the motion, over a part of a step.
namespace drev {

struct LawWork {
  double input = 0.0;       ///< put in by what varies in the laws and their ends [J]
  double dissipated = 0.0;  ///< J

  LawWork& operator+=(const LawWork& other) {
    input += other.input;
    dissipated += other.dissipated;
    return *this;
  }
  /// Adds a moment of dt: force y, rate x', the unknowns' part of it, and what of y x' is lost [W]. Where the stored
  /// energy varies with the angle, its change over the step is to be added to the input.
  void add(double dt, double y, double rate, double rate_by_unknowns, double lost, bool varies) {
    dissipated += dt * lost;
    // What the law's energy gains beyond its ends' work comes from what varies in it.
    input += varies ? dt * (lost - y * rate_by_unknowns) : dt * y * (rate - rate_by_unknowns);
  }
};

}  // namespace drev
