#include "estimator/method.h"

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
};

// Every method, once.
constexpr std::array kMethods{
    Entry{"lee2014", make<Lee2014>},
    Entry{"harmonic", make<Harmonic>},
    Entry{"realtime", make<Realtime>},
    Entry{"smoothed", make<Smoothed>},
    Entry{"spectral", make<Spectral>},
    Entry{"directional", make<Directional>},
};

}  // namespace

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const Entry& entry : kMethods) names.emplace_back(entry.name);
  return names;
}

std::unique_ptr<Method> make_method(std::string_view name, const MethodSettings& settings) {
  std::string known;
  for (const Entry& entry : kMethods) {
    if (entry.name == name) return entry.make(settings);
    known.append(known.empty() ? "" : ", ").append(entry.name);
  }
  throw UserError("unknown method \"" + std::string(name) + "\", expected one of " + known);
}

}  // namespace waverig::estimator
