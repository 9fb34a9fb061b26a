// What a file holds, in 64 digits: tells whether two results came of the same input.
#pragma once
#include <filesystem>
#include <string>

namespace waverig::cli {

// SHA-256, hexadecimal; empty where the path is no file that could be read again (a pipe).
std::string sha256_of(const std::filesystem::path& path);

}  // namespace waverig::cli
