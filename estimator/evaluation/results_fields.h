// Every field of the results once, for both directions between structures and JSON. Private to the readers
// and writers.
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "estimator/evaluation/results.h"
#include "lcmtypes/error.h"

namespace waverig::evaluation::json {

using Json = nlohmann::ordered_json;

template <class T, class Structure>
concept Is = std::same_as<std::remove_const_t<T>, Structure>;

inline constexpr const char *kRegular = "regular", *kSea = "sea";

// Structure to JSON. Unknown numbers (NaN) are null in the file.
class Writer {
 public:
  explicit Writer(Json& json) : json_(json) {}
  void operator()(const char* key, double value) {
    json_[key] = std::isfinite(value) ? Json(value) : Json(nullptr);
  }
  void operator()(const char* key, const std::string& value) { json_[key] = value; }
  // Left out where unknown: what only some campaigns have.
  void known(const char* key, double value) {
    if (std::isfinite(value)) json_[key] = value;
  }
  void known(const char* key, const std::string& value) {
    if (!value.empty()) json_[key] = value;
  }
  void known(const char* key, Motion value) {
    if (value != Motion::kUnknown) json_[key] = value == Motion::kSea ? kSea : kRegular;
  }
  void operator()(const char* key, char value) { json_[key] = std::string(1, value); }
  template <std::integral Integer>
  void operator()(const char* key, Integer value) {
    json_[key] = value;
  }
  template <class Item>
  void operator()(const char* key, const std::vector<Item>& items) {
    Json& array = json_[key] = Json::array();
    for (const Item& item : items) {
      Writer writer(array.emplace_back(Json::object()));
      fields(writer, item);
    }
  }
  void operator()(const char* key, const JudgedSea& sea);
  // Many small structures as one array a field: a tenth of the text of an array of objects.
  void operator()(const char* key, const std::vector<JudgedWave>& waves);

 private:
  Json& json_;
};

// JSON to structure; complaints are UserErrors that name file, place, key, value and what was expected.
class Reader {
 public:
  Reader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
    if (!json_.is_object()) throw UserError(where_ + ": expected an object");
  }
  // A number that is missing is unknown, as null is: older versions knew fewer.
  void operator()(const char* key, double& value) {
    const auto found = json_.find(key);
    if (found == json_.end()) {
      value = estimator::kUnknown;
      return;
    }
    const Json& j = *found;
    if (!j.is_null() && !j.is_number()) throw wrong(key, "a number or null");
    value = j.is_null() ? estimator::kUnknown : j.get<double>();
  }
  void known(const char* key, double& value) { (*this)(key, value); }
  void known(const char* key, std::string& value) {
    value.clear();
    if (json_.contains(key)) (*this)(key, value);
  }
  void known(const char* key, Motion& value) {
    std::string name;
    known(key, name);
    if (!name.empty() && name != kSea && name != kRegular) throw wrong(key, "\"regular\" or \"sea\"");
    value = name.empty() ? Motion::kUnknown : name == kSea ? Motion::kSea : Motion::kRegular;
  }
  void operator()(const char* key, std::string& value) {
    const Json& j = at(key, "a string");
    if (!j.is_string()) throw wrong(key, "a string");
    value = j.get<std::string>();
  }
  void operator()(const char* key, char& value) {
    std::string text;
    (*this)(key, text);
    if (text.size() != 1) throw wrong(key, "one letter");
    value = text[0];
  }
  void operator()(const char* key, bool& value) {
    const Json& j = at(key, "true or false");
    if (!j.is_boolean()) throw wrong(key, "true or false");
    value = j.get<bool>();
  }
  template <std::integral Integer>
  void operator()(const char* key, Integer& value) {
    const Json& j = at(key, "a whole number");
    if (!j.is_number_integer()) throw wrong(key, "a whole number");
    value = j.get<Integer>();
  }
  template <class Item>
  void operator()(const char* key, std::vector<Item>& items) {
    const Json& array = at(key, "an array");
    if (!array.is_array()) throw wrong(key, "an array");
    items.clear();
    for (const Json& element : array) {
      Reader reader(element, fmt::format("{}, {}[{}]", where_, key, items.size()));
      fields(reader, items.emplace_back());
    }
  }
  void operator()(const char* key, JudgedSea& sea);
  void operator()(const char* key, std::vector<JudgedWave>& waves);

 private:
  const Json& at(const char* key, const char* expected) const {
    const auto found = json_.find(key);
    if (found == json_.end())
      throw UserError(fmt::format("{}: key '{}' is missing; expected {}", where_, key, expected));
    return *found;
  }
  UserError wrong(const char* key, const char* expected) const {
    return UserError(fmt::format("{}: key '{}' is {}; expected {}", where_, key,
                                 json_.at(key).dump().substr(0, 40), expected));
  }

  const Json& json_;
  std::string where_;
};

void fields(auto& a, Is<Contribution> auto& c) {
  a("name", c.name);
  a("sigma_m", c.sigma_m);
  a("type", c.type);
}

void fields(auto& a, Is<HeightStatistics> auto& s) {
  a("waves", s.waves);
  a("mean_height_m", s.mean_height_m);
  a("error_rate_percent", s.error_rate_percent);
  a("std_m", s.std_m);
  a("rmse_m", s.rmse_m);
  a("mean_error_percent", s.mean_error_percent);
  a("mean_true_height_m", s.mean_true_height_m);
  a("expanded_uncertainty_m", s.expanded_uncertainty_m);
  a("bound_std_m", s.bound_std_m);
  a("mean_period_s", s.mean_period_s);
  a("budget", s.budget);
  a("flags", s.flags);
}

void fields(auto& a, Is<JudgedWave> auto& w) {
  a("start_utime", w.wave.start_utime);
  a("seq", w.wave.seq);
  a("period_s", w.wave.period_s);
  a("height_m", w.wave.height_m);
  a("true_height_m", w.true_height_m);
  a("noise_sigma_m", w.wave.noise_sigma_m);
  a("calibration_sigma_m", w.wave.calibration_sigma_m);
  a("tilt_sigma_m", w.wave.tilt_sigma_m);
  a("frequency_sigma_m", w.wave.frequency_sigma_m);
  a("flags", w.wave.flags);
}

void fields(auto& a, Is<JudgedSea> auto& judged) {
  auto& s = judged.sea;
  a("start_utime", s.start_utime);
  a("seq", s.seq);
  a("duration_s", s.duration_s);
  a("hm0_m", s.hm0_m);
  a("hm0_sigma_m", s.hm0_sigma_m);
  a("hm0_systematic_sigma_m", s.hm0_systematic_sigma_m);
  a("tp_s", s.tp_s);
  a("tm01_s", s.tm01_s);
  a("tm02_s", s.tm02_s);
  a("tm_10_s", s.tm_10_s);
  a("h13_m", s.h13_m);
  a("h110_m", s.h110_m);
  a("hmax_m", s.hmax_m);
  a("mean_direction_rad", s.mean_direction_rad);
  a("spread_rad", s.spread_rad);
  a("peak_direction_rad", s.peak_direction_rad);
  a("check_factor", s.check_factor);
  a("flags", s.flags);
  a("true_hm0_m", judged.true_hm0_m);
  a("true_tm02_s", judged.true_tm02_s);
  a.known("true_direction_rad", judged.direction.mean_direction_rad);
  a.known("true_spread_rad", judged.direction.spread_rad);
  a.known("true_check_factor", judged.direction.check_factor);
}

void fields(auto& a, Is<RunResult> auto& r) {
  a("run", r.run);
  a("method", r.method);
  a("repeat", r.repeat);
  a("period_s", r.period_s);
  a("height_m", r.height_m);
  a.known("motion", r.motion);
  fields(a, r.statistics);
  a("heave_rmse_m", r.heave_rmse_m);
  a.known("heave_bound_m", r.heave_bound_m);
  a("heave_gain", r.heave_gain);
  a("heave_lag_s", r.heave_lag_s);
  a("heave_sigma_ratio", r.heave_sigma_ratio);
  a("true_hm0_m", r.true_hm0_m);
  a("true_tm02_s", r.true_tm02_s);
  a("noise_density_mps2_rthz", r.noise_density_mps2_rthz);
  a("excluded_waves", r.excluded_waves);
  a.known("heave_coverage", r.heave_coverage);
  a("single_waves", r.waves);
  a("seas", r.seas);
}

void fields(auto& a, Is<CellResult> auto& c) {
  a("period_s", c.period_s);
  a("height_m", c.height_m);
  a("method", c.method);
  a.known("motion", c.motion);
  fields(a, c.statistics);
  a("heave_rmse_m", c.heave_rmse_m);
  a.known("heave_bound_m", c.heave_bound_m);
  a("true_hm0_m", c.true_hm0_m);
  a("heave_gain", c.heave_gain);
  a("heave_lag_s", c.heave_lag_s);
  a("heave_sigma_ratio", c.heave_sigma_ratio);
  a("sea", c.sea);
  a.known("direction_error_rad", c.direction_error_rad);
  a.known("direction_rmse_rad", c.direction_rmse_rad);
}

// Everything but calibration, cells and runs.
void head_fields(auto& a, Is<CampaignResults> auto& r) {
  a("name", r.name);
  a("version", r.version);
  a("command", r.command);
  a.known("judged_version", r.judged_version);
  a.known("judged_command", r.judged_command);
  a("seed", r.seed);
  a("complete", r.complete);
}

inline void Writer::operator()(const char* key, const JudgedSea& sea) {
  Writer writer(json_[key] = Json::object());
  fields(writer, sea);
}

inline void Reader::operator()(const char* key, JudgedSea& sea) {
  sea = {};
  if (!json_.contains(key)) return;
  Reader reader(json_.at(key), fmt::format("{}, {}", where_, key));
  fields(reader, sea);
}

inline void Writer::operator()(const char* key, const std::vector<JudgedWave>& waves) {
  Json& columns = json_[key] = Json::object();
  for (const JudgedWave& wave : waves) {
    Json row = Json::object();
    Writer writer(row);
    fields(writer, wave);
    for (auto& [name, value] : row.items()) columns[name].push_back(std::move(value));
  }
}

inline void Reader::operator()(const char* key, std::vector<JudgedWave>& waves) {
  const Json& columns = at(key, "an object of arrays");
  if (!columns.is_object()) throw wrong(key, "an object of arrays");
  std::size_t rows = 0;
  for (const auto& [name, column] : columns.items()) {
    if (!column.is_array()) throw wrong(key, "an object of arrays");
    rows = &column == &columns.front() ? column.size() : rows;
    if (column.size() != rows) throw wrong(key, "arrays of one length");
  }
  waves.assign(rows, {});
  for (std::size_t i = 0; i < rows; ++i) {
    Json row = Json::object();
    for (const auto& [name, column] : columns.items()) row[name] = column[i];
    Reader reader(row, fmt::format("{}, {}[{}]", where_, key, i));
    fields(reader, waves[i]);
  }
}

}  // namespace waverig::evaluation::json
