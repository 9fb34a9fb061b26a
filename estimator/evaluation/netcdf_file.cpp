#include "estimator/evaluation/netcdf_file.h"

#include <fmt/format.h>
#include <netcdf.h>
#include <netcdf_mem.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "estimator/evaluation/flag_names.h"
#include "estimator/evaluation/waves_csv.h"
#include "lcmtypes/atomic_file.h"

namespace waverig::evaluation {
namespace {

// One NetCDF file; nothing of it is left unless committed. Made in memory, since HDF5 crashes on a disk that
// is full; its file is padded with zeros to whole blocks of 64 KiB then.
class File {
 public:
  explicit File(std::filesystem::path path) : path_(std::move(path)) {
    check(nc_create_mem(path_.filename().c_str(), NC_NETCDF4, 0, &id_));
    open_ = true;
  }
  ~File() {
    if (open_) nc_abort(id_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void attribute(const char* name, std::string_view text, int variable = NC_GLOBAL) {
    check(nc_put_att_text(id_, variable, name, text.size(), text.data()));
  }
  int dimension(const char* name, std::size_t size) {
    int dimension = 0;
    check(nc_def_dim(id_, name, size, &dimension));
    return dimension;
  }
  // dimensions: none for a scalar. standard_name may be empty where CF knows none.
  int variable(const char* name, nc_type type, std::span<const int> dimensions, const char* units,
               std::string_view standard_name, std::string_view long_name) {
    int variable = 0;
    check(nc_def_var(id_, name, type, static_cast<int>(dimensions.size()), dimensions.data(), &variable));
    attribute("units", units, variable);
    if (!standard_name.empty()) attribute("standard_name", standard_name, variable);
    attribute("long_name", long_name, variable);
    if (type == NC_DOUBLE) {
      const double unknown = estimator::kUnknown;
      check(nc_put_att_double(id_, variable, "_FillValue", NC_DOUBLE, 1, &unknown));
    }
    if (!dimensions.empty()) check(nc_def_var_deflate(id_, variable, 1, 1, 1));
    return variable;
  }
  void put(int variable, std::span<const double> values) {
    if (!values.empty()) check(nc_put_var_double(id_, variable, values.data()));
  }
  void put(int variable, std::span<const std::int64_t> values) {
    const std::vector<long long> copy(values.begin(), values.end());
    if (!copy.empty()) check(nc_put_var_longlong(id_, variable, copy.data()));
  }
  void end_definitions() { check(nc_enddef(id_)); }
  void commit() {
    NC_memio made{};
    open_ = false;
    check(nc_close_memio(id_, &made));
    const std::unique_ptr<void, void (*)(void*)> bytes(made.memory, std::free);
    write_atomically(path_, {static_cast<const char*>(made.memory), made.size});
  }

 private:
  void check(int status) const {
    if (status != NC_NOERR)
      throw std::runtime_error(fmt::format("{}: {}", path_.string(), nc_strerror(status)));
  }

  std::filesystem::path path_;
  int id_ = 0;
  bool open_ = false;
};

constexpr const char* kTimeUnits = "microseconds since 1970-01-01T00:00:00Z";

struct Parameter {
  const char* name;
  const char* units;
  const char* standard_name;
  const char* long_name;
  double Summary::*value;
};

constexpr Parameter kParameters[] = {
    {"hm0", "m", "sea_surface_wave_significant_height", "4 sqrt(m0)", &Summary::hm0_m},
    {"h13", "m", "", "mean of the highest third, counted", &Summary::h13_m},
    {"h110", "m", "sea_surface_wave_mean_height_of_highest_tenth", "mean of the highest tenth, counted",
     &Summary::h110_m},
    {"hmax", "m", "sea_surface_wave_maximum_height", "highest single wave", &Summary::hmax_m},
    {"hmean", "m", "sea_surface_wave_mean_height", "mean of the single waves", &Summary::mean_height_m},
    {"hmean_expanded_uncertainty", "m", "", "expanded uncertainty of hmean, k = 2",
     &Summary::expanded_uncertainty_m},
    {"tz", "s", "sea_surface_wave_zero_upcrossing_period", "mean period, counted", &Summary::mean_period_s},
    {"tm01", "s", "sea_surface_wave_mean_period_from_variance_spectral_density_first_frequency_moment",
     "m0 / m1", &Summary::tm01_s},
    {"tm02", "s", "sea_surface_wave_mean_period_from_variance_spectral_density_second_frequency_moment",
     "sqrt(m0 / m2)", &Summary::tm02_s},
    {"tp", "s", "sea_surface_wave_period_at_variance_spectral_density_maximum", "peak period",
     &Summary::tp_s},
    {"mean_direction", "degree", "sea_surface_wave_from_direction", "mean direction from, true",
     &Summary::mean_direction_deg},
    {"spread", "degree", "sea_surface_wave_directional_spread", "directional spread", &Summary::spread_deg},
    {"peak_direction", "degree", "sea_surface_wave_from_direction_at_variance_spectral_density_maximum",
     "direction from at the peak, true", &Summary::peak_direction_deg},
    {"check_factor", "1", "", "horizontal over vertical motion", &Summary::check_factor},
};

}  // namespace

void write_netcdf(const std::filesystem::path& path, const NetcdfRecord& record) {
  File file(path);
  file.attribute("Conventions", "CF-1.9");
  file.attribute("title", record.title);
  file.attribute("source", record.source);
  file.attribute("method", record.summary.method);
  file.attribute("quality_flags", fmt::format("{}", fmt::join(flag_names(record.summary.flags), " ")));

  const int time[] = {file.dimension("time", record.heave.utime.size())};
  const int wave[] = {file.dimension("wave", record.waves.size())};
  const int frequency[] = {file.dimension("frequency", record.spectrum.frequency_hz.size())};
  const int time_id = file.variable("time", NC_INT64, time, kTimeUnits, "time", "time of the sample");
  const int heave_id =
      file.variable("heave", NC_DOUBLE, time, "m", "platform_heave_up", "heave, up positive");
  const int sigma_id = file.variable("heave_sigma", NC_DOUBLE, time, "m", "platform_heave_up standard_error",
                                     "standard uncertainty of heave, k = 1");
  const int start_id =
      file.variable("wave_start", NC_INT64, wave, kTimeUnits, "time", "start of the single wave");
  const int period_id = file.variable("wave_period", NC_DOUBLE, wave, "s", "", "period of the single wave");
  const int height_id =
      file.variable("wave_height", NC_DOUBLE, wave, "m", "", "height of the single wave, crest to trough");
  const int height_sigma_id = file.variable("wave_height_sigma", NC_DOUBLE, wave, "m", "",
                                            "standard uncertainty of the height, k = 1");
  const int frequency_id =
      file.variable("frequency", NC_DOUBLE, frequency, "Hz", "wave_frequency", "frequency");
  const int density_id =
      file.variable("wave_energy_density", NC_DOUBLE, frequency, "m2 s",
                    "sea_surface_wave_variance_spectral_density", "variance density of heave");
  std::vector<std::pair<int, double>> scalars;
  for (const Parameter& p : kParameters)
    if (std::isfinite(record.summary.*p.value))
      scalars.emplace_back(file.variable(p.name, NC_DOUBLE, {}, p.units, p.standard_name, p.long_name),
                           record.summary.*p.value);
  file.end_definitions();

  file.put(time_id, record.heave.utime);
  file.put(heave_id, record.heave.heave_m);
  file.put(sigma_id, record.heave.heave_sigma_m);
  std::vector<std::int64_t> start;
  std::vector<double> period, height, height_sigma;
  for (const estimator::Wave& w : record.waves) {
    start.push_back(w.start_utime);
    period.push_back(w.period_s);
    height.push_back(w.height_m);
    height_sigma.push_back(combined_sigma_m(w));
  }
  file.put(start_id, start);
  file.put(period_id, period);
  file.put(height_id, height);
  file.put(height_sigma_id, height_sigma);
  file.put(frequency_id, record.spectrum.frequency_hz);
  file.put(density_id, record.spectrum.density_m2_per_hz);
  for (const auto& [id, value] : scalars) file.put(id, std::span(&value, 1));
  file.commit();
}

}  // namespace waverig::evaluation
