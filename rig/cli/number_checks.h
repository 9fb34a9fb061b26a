// Checks of numbers on the command line: CLI11's own take NaN, name the largest double as a bound, and let a
// minus sign through to unsigned numbers.
#pragma once
#include <CLI/CLI.hpp>

namespace waverig::cli {

CLI::Validator not_negative();
CLI::Validator positive();
CLI::Validator finite();
CLI::Validator between(double low, double high);  // both included
CLI::Validator seed();                            // what a campaign file may hold

}  // namespace waverig::cli
