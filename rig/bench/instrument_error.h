// What can go wrong between the bench and an instrument, by kind: rules for retrying and ending go by it.
#pragma once
#include <stdexcept>
#include <string>

namespace waverig::rig::bench {

enum class FaultKind { kTimeout, kDisconnected, kRefused, kErrorQueue, kUnexpected, kOutOfRange, kData };

inline const char* name_of(FaultKind kind) {
  switch (kind) {
    case FaultKind::kTimeout:
      return "no answer in time";
    case FaultKind::kDisconnected:
      return "connection lost";
    case FaultKind::kRefused:
      return "cannot be reached";
    case FaultKind::kErrorQueue:
      return "error reported";
    case FaultKind::kUnexpected:
      return "unexpected answer";
    case FaultKind::kOutOfRange:
      return "out of range";
    case FaultKind::kData:
      return "data lost";
  }
  return "fault";
}

struct InstrumentError : std::runtime_error {
  InstrumentError(FaultKind k, std::string who, const std::string& what)
      : std::runtime_error(who + ": " + name_of(k) + ": " + what), kind(k), instrument(std::move(who)) {}
  FaultKind kind;
  std::string instrument;
};

}  // namespace waverig::rig::bench
