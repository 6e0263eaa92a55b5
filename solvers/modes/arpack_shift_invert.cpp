#include "solvers/modes/arpack_shift_invert.hpp"

#include <algorithm>
#include <arpack.h>
#include <cmath>
#include <mutex>
#include <numeric>
#include <vector>

namespace drev {

namespace {

std::string iteration_reason(a_int info, a_int converged, int count, int limit) {
  if (info == 1)
    return "only " + std::to_string(converged) + " of " + std::to_string(count) +
           " eigenpairs converged in " + std::to_string(limit) + " restarts";
  if (info == 3) return "no shifts could be applied: a larger basis is needed";
  if (info == -9999) return "no Lanczos basis could be built";
  return "dsaupd refused its input: info = " + std::to_string(info);
}

}  // namespace

/// Fractional parts of multiples of the golden ratio.
Vector shift_invert_start(int n, int start) {
  Vector r(n);
  for (int i = 0; i < n; ++i) {
    const double place = 0.6180339887498949 * (i + 1) + 0.4142135623730950 * start;
    r[i] = 0.5 + (place - std::floor(place));
  }
  return r;
}

ShiftInvertResult arpack_shift_invert(const ShiftInvertProblem& problem) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);

  ShiftInvertResult result;
  const int n = problem.size, k = problem.count;
  if (k < 1 || k >= n) {
    result.status = ArpackStatus::failed;
    result.reason = "count must be at least 1 and less than the number of unknowns";
    return result;
  }
  const int ncv = std::min(n, std::max(problem.basis, std::max(2 * k + 1, 20)));
  const int lworkl = ncv * (ncv + 8);
  Vector residual = shift_invert_start(n, problem.start), mass_times(n);
  Eigen::MatrixXd basis(n, ncv);
  std::vector<double> workd(idx(3 * n)), workl(idx(lworkl));
  a_int iparam[11] = {1, 0, problem.max_iterations, 1, 0, 0, 3, 0, 0, 0, 0};
  a_int ipntr[11] = {};
  a_int ido = 0, info = 1;  // info = 1: residual holds the start vector
  const auto mass = [&](const double* x, double* y) {
    if (problem.mass)
      problem.mass(x, y);
    else
      std::copy_n(x, n, y);
  };
  for (;;) {
    dsaupd_c(&ido, "G", n, "LM", k, 0.0, residual.data(), ncv, basis.data(), n, iparam, ipntr, workd.data(),
             workl.data(), lworkl, &info);
    if (ido == 99) break;
    const double* in = workd.data() + ipntr[0] - 1;
    double* out = workd.data() + ipntr[1] - 1;
    if (ido == 2) {
      mass(in, out);
    } else if (ido == 1) {  // M x is there already
      problem.solve(workd.data() + ipntr[2] - 1, out);
      ++result.solves;
    } else {
      mass(in, mass_times.data());
      problem.solve(mass_times.data(), out);
      ++result.solves;
    }
  }
  if (info != 0) {
    result.status = info == 1 || info == 3 ? ArpackStatus::not_converged : ArpackStatus::failed;
    result.reason = iteration_reason(info, iparam[4], k, problem.max_iterations);
    return result;
  }

  Vector lambda(k);
  Eigen::MatrixXd vectors(n, k);
  std::vector<a_int> select(idx(ncv));
  dseupd_c(1, "A", select.data(), lambda.data(), vectors.data(), n, problem.sigma, "G", n, "LM", k, 0.0,
           residual.data(), ncv, basis.data(), n, iparam, ipntr, workd.data(), workl.data(), lworkl, &info);
  if (info != 0) {
    result.status = ArpackStatus::failed;
    result.reason = "dseupd: info = " + std::to_string(info);
    return result;
  }
  std::vector<int> order(idx(k));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return lambda[a] < lambda[b]; });
  result.lambda = lambda(order);
  result.vectors = vectors(Eigen::all, order);
  result.status = ArpackStatus::success;
  return result;
}

}  // namespace drev
