#pragma once
/// The Chain by the integrators of SUNDIALS 6: C. J. Gardner et al., ACM Trans. Math. Software 48,
/// 2022, doi:10.1145/3539801. Compressed Jacobian by formula, KLU, one thread.
#include "tests/benchmark/peers/chain.hpp"

namespace peers {

enum class Integrator {
  erk5,               ///< ARKODE explicit, order 5 as it comes (Cash, Karp)
  erk5_dopri,         ///< ARKODE explicit, Dormand and Prince 5(4)
  erk6,               ///< ARKODE explicit, Verner 6(5)
  erk8,               ///< ARKODE explicit, Fehlberg 8(7)
  adams,              ///< CVODE Adams, Newton with KLU
  adams_fixed_point,  ///< CVODE Adams, functional iteration
  bdf,                ///< CVODE BDF, KLU
  dirk4,              ///< ARKODE diagonally implicit, order 4, KLU
  dirk5,              ///< the same, order 5
  ida                 ///< IDA (BDF), KLU
};
const char* name(Integrator integrator);

struct SundialsOptions {
  Integrator integrator = Integrator::erk5;
  double rtol = 1e-6, t_end = 5.0;
  bool roots = true;  ///< contact changes by root finding; the integrator starts again at each
  int samples = 0;
};
/// Throws std::runtime_error where SUNDIALS reports that it could not be set up.
PeerRun run_sundials(const Chain& chain, const SundialsOptions& options);

}  // namespace peers
