// The version of this build, from project() and, in a checkout, the commit.
#pragma once
namespace waverig {
extern const char* const kVersion;
}
