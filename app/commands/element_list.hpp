#pragma once
/// `drev list --elements`: the types of elements of model files, those of plugins among them, with their
/// keys.
#include <string>

namespace drev::app {

std::string elements_as_text();
/// {elements: [{type, plugin (null: drev's own), keys: [{name, key, needed, translational_key}]}]}: `key` has
/// the SI unit, on a rotational node and on a translational one.
std::string elements_as_json();

}  // namespace drev::app
