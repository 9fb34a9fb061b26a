// Heave CSV: utime,heave_m[,heave_sigma_m] and whatever else stands to the right.
#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "estimator/types.h"
#include "lcmtypes/atomic_file.h"

namespace waverig::evaluation {

struct HeaveSeries {
  std::vector<std::int64_t> utime;    // microseconds, growing
  std::vector<double> heave_m;        // NaN where the file has an empty cell
  std::vector<double> heave_sigma_m;  // NaN where unknown; as long as the others
  std::vector<bool> moving;           // column "moving" where the file has one, else empty
};

// Plain or gzip. Throws UserError as SampleCsvReader does.
HeaveSeries read_heave_csv(const std::filesystem::path& path);

class HeaveCsvWriter {
 public:
  explicit HeaveCsvWriter(const std::filesystem::path& path);
  void write(const estimator::HeaveSample& sample);
  void flush();  // the disk has it; what stood under its name still stands
  void close();  // the file is there from now on

 private:
  AtomicFile file_;
};

}  // namespace waverig::evaluation
