#pragma once
/// What the shell offers for a word of the command line (app/cli/completion/drev.bash, drev.zsh).
#include <string>
#include <vector>

namespace drev::app {

/// words: those after "drev", the last one as far as it is written. What may stand in its place.
std::vector<std::string> completions(const std::vector<std::string>& words);

}  // namespace drev::app
