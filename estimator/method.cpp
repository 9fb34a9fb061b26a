#include "estimator/method.h"

#include <algorithm>
#include <array>

#include "estimator/compass/directional_method.h"
#include "estimator/heave/realtime.h"
#include "estimator/heave/smoothed.h"
#include "estimator/heave/spectral.h"
#include "estimator/waves/harmonic.h"
#include "estimator/waves/lee2014.h"
#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

template <class M>
std::unique_ptr<Method> make(const MethodSettings& settings) {
  return std::make_unique<M>(settings);
}

struct Entry {
  std::string_view name;
  std::unique_ptr<Method> (*make)(const MethodSettings&);
  bool tells_waves;
  bool takes_lag = false;  // fixed_lag_s
};

// Every method, once.
constexpr std::array kMethods{
    Entry{.name = "lee2014", .make = make<Lee2014>, .tells_waves = true},
    Entry{.name = "harmonic", .make = make<Harmonic>, .tells_waves = true},
    Entry{.name = "realtime", .make = make<Realtime>, .tells_waves = true, .takes_lag = true},
    Entry{.name = "smoothed", .make = make<Smoothed>, .tells_waves = true},
    Entry{.name = "spectral", .make = make<Spectral>, .tells_waves = true},
    Entry{.name = "directional", .make = make<Directional>, .tells_waves = false},
};

}  // namespace

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Entry& entry : kMethods) names.emplace_back(entry.name);
  return names;
}

bool tells_waves(std::string_view name) {
  return std::any_of(kMethods.begin(), kMethods.end(),
                     [&](const Entry& entry) { return entry.name == name && entry.tells_waves; });
}

std::unique_ptr<Method> make_method(std::string_view name, const MethodSettings& settings) {
  std::string known;
  for (const Entry& entry : kMethods) {
    if (entry.name == name && settings.fixed_lag_s != 0 && !entry.takes_lag)
      throw UserError("method \"" + std::string(name) +
                      "\" cannot be asked to answer late; expected no lag, or one that can: realtime");
    if (entry.name == name) return entry.make(settings);
    known.append(known.empty() ? "" : ", ").append(entry.name);
  }
  throw UserError("unknown method \"" + std::string(name) + "\", expected one of " + known);
}

}  // namespace waverig::estimator
