// Sample CSV: recordings of an inertial unit, in and out.
//   utime,ax,ay,az,gx,gy,gz[,mx,my,mz][,temperature]     microseconds, m/s^2, rad/s, uT, degC; body frame, z
//   down
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>

#include "estimator/evaluation/csv_reader.h"
#include "estimator/types.h"
#include "lcmtypes/atomic_file.h"

namespace waverig::evaluation {

// Reads one sample a row, plain or gzip, in constant memory. Throws UserError, naming file, line, column,
// value and what was expected, for a foreign header, a broken or non-finite number, a time that does not
// grow, or no row at all. Magnetometer and temperature cells may be empty: sensors with a slower rate leave
// them so.
class SampleCsvReader {
 public:
  explicit SampleCsvReader(const std::filesystem::path& path);
  bool next(estimator::ImuSample& sample);

 private:
  CsvReader csv_;
  int mag_ = -1, temperature_ = -1;  // column, -1 where there is none
  std::int64_t rows_ = 0;
  std::int64_t last_utime_ = 0;
};

class SampleCsvWriter {
 public:
  SampleCsvWriter(const std::filesystem::path& path, bool magnetometer, bool temperature);
  void write(const estimator::ImuSample& sample);
  void close();  // the file is there from now on

 private:
  AtomicFile file_;
  bool magnetometer_, temperature_;
};

}  // namespace waverig::evaluation
