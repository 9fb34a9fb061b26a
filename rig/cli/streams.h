// The standard streams, where others have closed them or their disk is full.
#pragma once

namespace waverig::cli {

// A file that is opened while a standard stream is closed would take its place, and be written into by
// whatever is said there: closed ones are opened, so that what is said fails or goes nowhere.
void hold_standard_streams();

// Throws std::runtime_error where not everything that was said on stdout could be written.
void finish_stdout();

}  // namespace waverig::cli
