// Errors that end a command. The program turns UserError into exit status 2 and one line on stderr.
#pragma once
#include <stdexcept>

namespace waverig {

// Bad usage or bad input: the message is one sentence that names file, line, key, value and what was expected.
struct UserError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// It ran and the answer is no (limits exceeded, comparison failed, alarm): exit status 1.
struct NegativeAnswer : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace waverig
