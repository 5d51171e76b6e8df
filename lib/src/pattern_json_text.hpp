// What both directions of pattern_json.hpp use: the text of one entry of a list. The reader tells equal entries by it.
#pragma once

#include <string>

#include <burin/pattern.hpp>

namespace burin::pattern_json {

std::string text_of(const Profile& profile);
std::string text_of(const Material& material);
std::string text_of(const Perturbation& perturbation);

}  // namespace burin::pattern_json
