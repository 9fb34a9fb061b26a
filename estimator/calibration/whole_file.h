// A calibration file is there whole or not at all: an earlier one stands until the new one is on the disk.
#pragma once
#include <filesystem>
#include <string_view>

namespace waverig::estimator {

// Throws UserError where the place cannot be written, std::runtime_error where the disk did not take all.
void write_whole(const std::filesystem::path& path, std::string_view text);

}  // namespace waverig::estimator
