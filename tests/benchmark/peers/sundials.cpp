#include "tests/benchmark/peers/sundials.hpp"

#include <algorithm>
#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#include <ctime>
#include <cvode/cvode.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <stdexcept>
#include <string>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

namespace peers {

namespace {

/// What SUNDIALS hands back to the functions below.
struct Problem {
  const Chain* chain;
  bool roots;
  int sides[8] = {};
  std::vector<sunindextype> columns = {}, rows = {};  // of the Jacobian; (z, v) by columns
};

double* data(N_Vector v) { return NV_DATA_S(v); }

int right_side(realtype t, N_Vector y, N_Vector dy, void* user) {
  const auto& p = *static_cast<const Problem*>(user);
  const Chain& c = *p.chain;
  const double *z = data(y), *v = z + c.n;
  std::copy(v, v + c.n, data(dy));
  accelerations(c, t, z, v, p.roots ? p.sides : nullptr, data(dy) + c.n);
  return 0;
}

int residual(realtype t, N_Vector y, N_Vector dy, N_Vector r, void* user) {
  right_side(t, y, r, user);
  double* out = data(r);
  const double* rate = data(dy);
  const int n = 2 * static_cast<const Problem*>(user)->chain->n;
  for (int i = 0; i < n; ++i) out[i] = rate[i] - out[i];
  return 0;
}

/// The flanks' bounds, which fall to zero at a change.
int bounds(realtype, N_Vector y, realtype* g, void* user) {
  const auto& p = *static_cast<const Problem*>(user);
  for (std::size_t j = 0; j < p.chain->meshes.size(); ++j) {
    const Mesh& m = p.chain->meshes[j];
    const double x = deflection(m, data(y));
    for (const int b : {0, 1}) *g++ = stays(m, p.sides[j], x, b);
  }
  return 0;
}
int dae_bounds(realtype t, N_Vector y, N_Vector, realtype* g, void* user) { return bounds(t, y, g, user); }

void find_pattern(Problem& p) {
  const Chain& c = *p.chain;
  p.columns.assign(1, 0);
  for (int j = 0; j < c.n; ++j) {
    std::vector<int> in{j - 1, j, j + 1};
    for (const Mesh& m : c.meshes)
      if (m.b >= 0 && (m.a == j || m.b == j)) in.push_back(m.a), in.push_back(m.b);
    std::sort(in.begin(), in.end());
    in.erase(std::unique(in.begin(), in.end()), in.end());
    p.rows.push_back(j);
    for (const int i : in)
      if (i >= 0 && i < c.n) p.rows.push_back(c.n + i);
    p.columns.push_back(static_cast<sunindextype>(p.rows.size()));
  }
  for (int j = 0; j < c.n; ++j) {
    p.rows.push_back(j);
    p.rows.push_back(c.n + j);
    p.columns.push_back(static_cast<sunindextype>(p.rows.size()));
  }
}

/// sign (df/dy) + shift I.
void fill(const Problem& p, double t, N_Vector y, double sign, double shift, SUNMatrix out) {
  const Chain& c = *p.chain;
  const double* z = data(y);
  std::copy(p.columns.begin(), p.columns.end(), SUNSparseMatrix_IndexPointers(out));
  std::copy(p.rows.begin(), p.rows.end(), SUNSparseMatrix_IndexValues(out));
  double* values = SUNSparseMatrix_Data(out);
  for (int j = 0; j < c.n; ++j) {
    *values++ = shift;  // dz_j/dz_j
    for (auto s = p.columns[static_cast<std::size_t>(j)] + 1; s < p.columns[static_cast<std::size_t>(j) + 1];
         ++s) {
      const int i = static_cast<int>(p.rows[static_cast<std::size_t>(s)]) - c.n;
      double a = 0.0;
      if (i == j) a = -c.main[i] + load_slope(c, t, z[i], i);
      if (i == j + 1) a = -c.low[i];
      if (i == j - 1) a = -c.up[i];
      for (std::size_t k = 0; k < c.meshes.size(); ++k) {
        const Mesh& m = c.meshes[k];
        const int s_k = p.roots ? p.sides[k] : side(m, deflection(m, z));
        if (s_k == 0 || (i != m.a && i != m.b) || (j != m.a && j != m.b)) continue;
        a -= (i == m.a ? m.push_a : m.push_b) * m.k * (j == m.a ? m.arm_a : m.arm_b);
      }
      *values++ = sign * a;
    }
  }
  for (int j = 0; j < c.n; ++j) {
    *values++ = sign;  // dz_j/dv_j
    *values++ = shift - sign * c.damping[j];
  }
}

int jacobian(realtype t, N_Vector y, N_Vector, SUNMatrix out, void* user, N_Vector, N_Vector, N_Vector) {
  fill(*static_cast<const Problem*>(user), t, y, 1.0, 0.0, out);
  return 0;
}
int dae_jacobian(realtype t, realtype c_j, N_Vector y, N_Vector, N_Vector, SUNMatrix out, void* user,
                 N_Vector, N_Vector, N_Vector) {
  fill(*static_cast<const Problem*>(user), t, y, -1.0, c_j, out);
  return 0;
}

void check(int flag, const char* what) {
  if (flag < 0)
    throw std::runtime_error(std::string("SUNDIALS: ") + what + " returned " + std::to_string(flag));
}

void silent(int, const char*, const char*, char*, void*) {}

class Run {
 public:
  Run(const Chain& chain, const SundialsOptions& options)
      : c_(chain), o_(options), n_(2 * chain.n), problem_{&chain, options.roots} {
    check(SUNContext_Create(nullptr, &context_), "SUNContext_Create");
    y_ = N_VNew_Serial(n_, context_);
    dy_ = N_VNew_Serial(n_, context_);
    tolerance_ = N_VNew_Serial(n_, context_);
    N_VConst(0.0, y_);
    for (int i = 0; i < n_; ++i) data(tolerance_)[i] = o_.rtol * (i < c_.n ? kAngleScale : kSpeedScale);
    find_pattern(problem_);
    right_side(0.0, y_, dy_, &problem_);
    create();
  }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  ~Run() {
    if (cvode()) CVodeFree(&memory_);
    if (erk()) ERKStepFree(&memory_);
    if (dirk()) ARKStepFree(&memory_);
    if (ida()) IDAFree(&memory_);
    if (nonlinear_) SUNNonlinSolFree(nonlinear_);
    if (linear_) SUNLinSolFree(linear_);
    if (matrix_) SUNMatDestroy(matrix_);
    for (N_Vector v : {y_, dy_, tolerance_}) N_VDestroy(v);
    SUNContext_Free(&context_);
  }

  PeerRun run() {
    const std::clock_t start = std::clock();
    PeerRun r;
    Sampler sampler(o_.t_end, o_.samples);
    const double chunk = o_.t_end / 50.0;
    double t = 0.0;
    int part = 1;
    while (t < o_.t_end) {
      const double stop = part == 50 ? o_.t_end : part * chunk;
      const int flag = evolve(stop, t);
      if (flag < 0) break;  // t says how far it came
      if (flag == CV_ROOT_RETURN) pass(t), ++r.changes;
      if (o_.samples) sampler.see(t, data(y_)[c_.end], r.samples);
      if (t >= stop) ++part;
      if (flag != CV_ROOT_RETURN || r.changes % 64 == 0)
        if (t >= stop && seconds(start) > kPatience) break;
    }
    r.seconds = seconds(start);
    r.t_end = t;
    count(r);
    return r;
  }

 private:
  bool erk() const { return o_.integrator <= Integrator::erk8; }
  bool cvode() const { return o_.integrator >= Integrator::adams && o_.integrator <= Integrator::bdf; }
  bool dirk() const { return o_.integrator == Integrator::dirk4 || o_.integrator == Integrator::dirk5; }
  bool ida() const { return o_.integrator == Integrator::ida; }
  int root_count() const { return o_.roots ? 2 * static_cast<int>(c_.meshes.size()) : 0; }

  static double seconds(std::clock_t start) {
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  }

  void create() {
    if (!erk() && o_.integrator != Integrator::adams_fixed_point) {
      matrix_ = SUNSparseMatrix(n_, n_, problem_.columns.back(), CSC_MAT, context_);
      linear_ = SUNLinSol_KLU(y_, matrix_, context_);
      if (!linear_) throw std::runtime_error("SUNDIALS: no KLU");
    }
    std::vector<int> falling(8, -1);
    const long many = 1000000000;
    const int roots = root_count();
    if (erk()) {
      memory_ = ERKStepCreate(right_side, 0.0, y_, context_);
      switch (o_.integrator) {
        case Integrator::erk5:
          check(ERKStepSetOrder(memory_, 5), "SetOrder");
          break;
        case Integrator::erk5_dopri:
          check(ERKStepSetTableNum(memory_, ARKODE_DORMAND_PRINCE_7_4_5), "SetTableNum");
          break;
        case Integrator::erk6:
          check(ERKStepSetTableNum(memory_, ARKODE_VERNER_8_5_6), "SetTableNum");
          break;
        default:
          check(ERKStepSetTableNum(memory_, ARKODE_FEHLBERG_13_7_8), "SetTableNum");
      }
      check(ERKStepSVtolerances(memory_, o_.rtol, tolerance_), "tolerances");
      ERKStepSetUserData(memory_, &problem_);
      ERKStepSetMaxNumSteps(memory_, many);
      ERKStepSetStopTime(memory_, o_.t_end);
      ERKStepSetErrHandlerFn(memory_, silent, nullptr);
      if (roots) ERKStepRootInit(memory_, roots, bounds);
      if (roots) ERKStepSetRootDirection(memory_, falling.data());
    } else if (dirk()) {
      memory_ = ARKStepCreate(nullptr, right_side, 0.0, y_, context_);
      check(ARKStepSetOrder(memory_, o_.integrator == Integrator::dirk4 ? 4 : 5), "SetOrder");
      check(ARKStepSVtolerances(memory_, o_.rtol, tolerance_), "tolerances");
      check(ARKStepSetLinearSolver(memory_, linear_, matrix_), "SetLinearSolver");
      check(ARKStepSetJacFn(memory_, jacobian), "SetJacFn");
      ARKStepSetUserData(memory_, &problem_);
      ARKStepSetMaxNumSteps(memory_, many);
      ARKStepSetStopTime(memory_, o_.t_end);
      ARKStepSetErrHandlerFn(memory_, silent, nullptr);
      if (roots) ARKStepRootInit(memory_, roots, bounds);
      if (roots) ARKStepSetRootDirection(memory_, falling.data());
    } else if (cvode()) {
      memory_ = CVodeCreate(o_.integrator == Integrator::bdf ? CV_BDF : CV_ADAMS, context_);
      check(CVodeInit(memory_, right_side, 0.0, y_), "CVodeInit");
      check(CVodeSVtolerances(memory_, o_.rtol, tolerance_), "tolerances");
      if (linear_) {
        check(CVodeSetLinearSolver(memory_, linear_, matrix_), "SetLinearSolver");
        check(CVodeSetJacFn(memory_, jacobian), "SetJacFn");
      } else {
        nonlinear_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
        check(CVodeSetNonlinearSolver(memory_, nonlinear_), "SetNonlinearSolver");
      }
      CVodeSetUserData(memory_, &problem_);
      CVodeSetMaxNumSteps(memory_, many);
      CVodeSetStopTime(memory_, o_.t_end);
      CVodeSetErrHandlerFn(memory_, silent, nullptr);
      if (roots) CVodeRootInit(memory_, roots, bounds);
      if (roots) CVodeSetRootDirection(memory_, falling.data());
    } else {
      memory_ = IDACreate(context_);
      check(IDAInit(memory_, residual, 0.0, y_, dy_), "IDAInit");
      check(IDASVtolerances(memory_, o_.rtol, tolerance_), "tolerances");
      check(IDASetLinearSolver(memory_, linear_, matrix_), "SetLinearSolver");
      check(IDASetJacFn(memory_, dae_jacobian), "SetJacFn");
      IDASetUserData(memory_, &problem_);
      IDASetMaxNumSteps(memory_, many);
      IDASetStopTime(memory_, o_.t_end);
      IDASetErrHandlerFn(memory_, silent, nullptr);
      if (roots) IDARootInit(memory_, roots, dae_bounds);
      if (roots) IDASetRootDirection(memory_, falling.data());
    }
  }

  /// Step by step where samples are wanted, else on to the stop.
  int evolve(double stop, double& t) {
    const bool one = o_.samples > 0;
    if (erk()) return ERKStepEvolve(memory_, stop, y_, &t, one ? ARK_ONE_STEP : ARK_NORMAL);
    if (dirk()) return ARKStepEvolve(memory_, stop, y_, &t, one ? ARK_ONE_STEP : ARK_NORMAL);
    if (cvode()) return CVode(memory_, stop, y_, &t, one ? CV_ONE_STEP : CV_NORMAL);
    return IDASolve(memory_, stop, &t, y_, dy_, one ? IDA_ONE_STEP : IDA_NORMAL);
  }

  /// A flank met or left: on from here with the new side.
  void pass(double t) {
    int found[8] = {};
    if (erk()) ERKStepGetRootInfo(memory_, found);
    if (dirk()) ARKStepGetRootInfo(memory_, found);
    if (cvode()) CVodeGetRootInfo(memory_, found);
    if (ida()) IDAGetRootInfo(memory_, found);
    for (int i = 0; i < root_count(); ++i)
      if (found[i]) problem_.sides[i / 2] = problem_.sides[i / 2] ? 0 : i % 2 == 0 ? 1 : -1;
    if (erk()) check(ERKStepReset(memory_, t, y_), "Reset");
    if (dirk()) check(ARKStepReset(memory_, t, y_), "Reset");
    if (cvode()) add_counts(), check(CVodeReInit(memory_, t, y_), "ReInit");
    if (ida()) {
      add_counts();
      right_side(t, y_, dy_, &problem_);
      check(IDAReInit(memory_, t, y_, dy_), "ReInit");
    }
  }

  void add_counts() {
    long steps = 0, evaluations = 0;
    if (cvode()) CVodeGetNumSteps(memory_, &steps), CVodeGetNumRhsEvals(memory_, &evaluations);
    if (ida()) IDAGetNumSteps(memory_, &steps), IDAGetNumResEvals(memory_, &evaluations);
    steps_ += steps, evaluations_ += evaluations;
  }

  void count(PeerRun& r) {
    add_counts();
    long explicit_ = 0;
    if (erk()) ERKStepGetNumSteps(memory_, &steps_), ERKStepGetNumRhsEvals(memory_, &evaluations_);
    if (dirk())
      ARKStepGetNumSteps(memory_, &steps_), ARKStepGetNumRhsEvals(memory_, &explicit_, &evaluations_);
    r.steps = steps_, r.evaluations = evaluations_;
  }

  const Chain& c_;
  SundialsOptions o_;
  int n_;
  Problem problem_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr, dy_ = nullptr, tolerance_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  SUNNonlinearSolver nonlinear_ = nullptr;
  void* memory_ = nullptr;
  long steps_ = 0, evaluations_ = 0;
};

}  // namespace

const char* name(Integrator integrator) {
  switch (integrator) {
    case Integrator::erk5:
      return "ARKODE explicit 5";
    case Integrator::erk5_dopri:
      return "ARKODE Dormand-Prince 5";
    case Integrator::erk6:
      return "ARKODE explicit 6";
    case Integrator::erk8:
      return "ARKODE explicit 8";
    case Integrator::adams:
      return "CVODE Adams, KLU";
    case Integrator::adams_fixed_point:
      return "CVODE Adams, fixed point";
    case Integrator::bdf:
      return "CVODE BDF, KLU";
    case Integrator::dirk4:
      return "ARKODE DIRK 4, KLU";
    case Integrator::dirk5:
      return "ARKODE DIRK 5, KLU";
    case Integrator::ida:
      return "IDA, KLU";
  }
  return "";
}

PeerRun run_sundials(const Chain& chain, const SundialsOptions& options) { return Run(chain, options).run(); }

}  // namespace peers
