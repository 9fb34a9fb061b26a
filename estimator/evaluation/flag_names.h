// The bits of lcmtypes/flags.h by name, for files and reports.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace waverig::evaluation {

std::vector<std::string> flag_names(std::int32_t flags);

}  // namespace waverig::evaluation
