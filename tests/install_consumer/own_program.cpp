// A program of one's own that runs a model file with an element of its own, by the installed libraries alone.
// The element is the plugin's, built in. Argument: the model file. Exit status 0: the peak is the closed
// form's.
//
// A torque T that sets in at once turns a disc from rest as far as its work is stored: T x = k x^2/2 + k3
// x^4/4, here 2250 N m and x = 0.1 rad, where the coupling has k x + k3 x^3 = 7000 N m.
#include <drev/app/model_file/model_file.hpp>
#include <drev/app/model_file/plugin.hpp>
#include <drev/app/run_model.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  drev_plugin_register();
  const drev::app::ModelFile file(argv[1], "");
  const drev::Parameters parameters(file.entry().name, file.entry().parameters);
  const drev::ModelCase read = file.entry().build(parameters);
  std::printf("%zu elements\n", read.model.element_instances().size());

  const drev::app::RunOutcome run = drev::app::run_model(
      {.model = argv[1],
       .options = {{"--out", {"own"}}, {"--format", {"hdf5"}}, {"--report", {"own.html"}}}});
  std::fputs(run.text.c_str(), stdout);
  const std::string key = "\"max_torque_Nm\": ";
  const std::size_t at = run.json.find(key);
  const double torque = at == std::string::npos ? 0.0 : std::atof(run.json.c_str() + at + key.size());
  std::printf("largest torque %.12g N m\n", torque);
  return run.ok() && std::abs(torque / 7000.0 - 1.0) < 2e-6 ? 0 : 1;
}
