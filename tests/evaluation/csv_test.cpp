#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <string>

#include "estimator/evaluation/heave_csv.h"
#include "estimator/evaluation/sample_csv.h"
#include "estimator/evaluation/waves_csv.h"
#include "lcmtypes/flags.h"
#include "tests/evaluation/recordings.h"
#include "tests/evaluation/scratch.h"

namespace waverig::evaluation {
namespace {

const std::string kHeader = "utime,ax,ay,az,gx,gy,gz\n";
const std::string kRow1 = "1000000,0.1,-0.2,-9.81,0.01,0.02,0.03\n";
const std::string kRow2 = "1010000,0.1,-0.2,-9.81,0.01,0.02,0.03\n";

int read_all(const std::filesystem::path& file) {
  SampleCsvReader reader(file);
  estimator::ImuSample sample;
  int rows = 0;
  while (reader.next(sample)) ++rows;
  return rows;
}

std::string complaint_about(const std::filesystem::path& file) {
  try {
    read_all(file);
  } catch (const UserError& error) {
    return error.what();
  }
  return "no complaint";
}

TEST(SampleCsv, ReadsEveryColumn) {
  const Scratch scratch;
  const auto file = scratch.write(
      "s.csv",
      "utime,ax,ay,az,gx,gy,gz,mx,my,mz,temperature\n1500000000000000,1,-2,+3e0,4,5,6,7,8,9,21.5\n"
      "1500000000003500, 1 ,2,3,4,5,6,,,,\n");
  SampleCsvReader reader(file);
  estimator::ImuSample s;
  ASSERT_TRUE(reader.next(s));
  EXPECT_EQ(s.utime, 1500000000000000);
  EXPECT_EQ(s.seq, 0);
  EXPECT_EQ(s.f_B, Vector3d(1, -2, 3));
  EXPECT_EQ(s.w_NB_B, Vector3d(4, 5, 6));
  EXPECT_EQ(s.m_B_uT, Vector3d(7, 8, 9));
  EXPECT_EQ(s.temperature_degC, 21.5);
  EXPECT_EQ(s.flags, 0);
  ASSERT_TRUE(reader.next(s));
  EXPECT_EQ(s.seq, 1);
  EXPECT_EQ(s.f_B, Vector3d(1, 2, 3));
  EXPECT_EQ(s.flags, flag::kNoMagnetometer);
  EXPECT_TRUE(std::isnan(s.temperature_degC));
  EXPECT_FALSE(reader.next(s));
}

TEST(SampleCsv, TakesWindowsLineEndsAMissingLastNewlineAndBlankLinesAtTheEnd) {
  const Scratch scratch;
  EXPECT_EQ(
      read_all(scratch.write("crlf.csv", "utime,ax,ay,az,gx,gy,gz\r\n1,1,2,3,4,5,6\r\n2,1,2,3,4,5,6\r\n")),
      2);
  EXPECT_EQ(read_all(scratch.write("open.csv", kHeader + "1,1,2,3,4,5,6")), 1);
  EXPECT_EQ(read_all(scratch.write("blank.csv", kHeader + "1,1,2,3,4,5,6\n\n  \n")), 1);
  EXPECT_EQ(read_all(scratch.write("bom.csv", "\xEF\xBB\xBF" + kHeader + "1,1,2,3,4,5,6\n")), 1);
}

struct Broken {
  const char* name;
  std::string text;
  std::vector<std::string> mentions;  // beside the file
};

class BrokenSampleCsv : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenSampleCsv, IsRefusedWithTheLineColumnValueAndWhatWasExpected) {
  const Scratch scratch;
  const auto file = scratch.write("broken.csv", GetParam().text);
  const std::string said = complaint_about(file);
  EXPECT_NE(said.find(file.string()), std::string::npos) << said;
  for (const std::string& mention : GetParam().mentions)
    EXPECT_NE(said.find(mention), std::string::npos) << said;
  EXPECT_EQ(said.find('\n'), std::string::npos) << said;
}

INSTANTIATE_TEST_SUITE_P(
    Table, BrokenSampleCsv,
    ::testing::Values(
        Broken{"Empty", "", {"empty", "expected a header"}},
        Broken{"HeaderOnly", kHeader, {"no samples", "expected at least one row"}},
        Broken{"ForeignHeader",
               "time,x,y\n1,2,3\n",
               {"line 1", "time,x,y", "expected 'utime,ax,ay,az,gx,gy,gz"}},
        Broken{"SwappedColumns", "utime,ay,ax,az,gx,gy,gz\n", {"line 1", "expected"}},
        Broken{"Word",
               kHeader + kRow1 + "1010000,0.1,oops,-9.81,0.01,0.02,0.03\n",
               {"line 3", "column ay", "'oops'", "expected a finite number"}},
        Broken{"Nan",
               kHeader + kRow1 + "1010000,0.1,0.2,nan,0.01,0.02,0.03\n",
               {"line 3", "column az", "'nan'", "finite"}},
        Broken{
            "Infinite", kHeader + "1,inf,0.2,1,0.01,0.02,0.03\n", {"line 2", "column ax", "'inf'", "finite"}},
        Broken{"Overflow", kHeader + "1,1e999,0.2,1,0.01,0.02,0.03\n", {"line 2", "column ax", "'1e999'"}},
        Broken{"EmptyCell", kHeader + "1,,0.2,1,0.01,0.02,0.03\n", {"line 2", "column ax", "''"}},
        Broken{"TrailingUnit", kHeader + "1,0.1g,0.2,1,0.01,0.02,0.03\n", {"line 2", "column ax", "'0.1g'"}},
        Broken{"TooFewCells", kHeader + kRow1 + kRow2 + "1020000,0.1\n", {"line 4", "2 cells", "expected 7"}},
        Broken{
            "TooManyCells", kHeader + kRow1 + "1010000,1,2,3,4,5,6,7\n", {"line 3", "8 cells", "expected 7"}},
        Broken{"BlankInside", kHeader + kRow1 + "\n" + kRow2, {"line 3", "empty"}},
        Broken{"TimeBackwards",
               kHeader + kRow2 + kRow1,
               {"line 3", "column utime", "'1000000'", "after 1010000"}},
        Broken{"TimeRepeated", kHeader + kRow1 + kRow1, {"line 3", "column utime", "after 1000000"}},
        Broken{"TimeInSeconds",
               kHeader + "1.5,1,2,3,4,5,6\n",
               {"line 2", "column utime", "'1.5'", "whole number"}},
        Broken{"EndlessLine", kHeader + std::string(200000, '7'), {"line 2", "longer than"}},
        Broken{"Binary",
               kHeader + std::string("1,\x01\x1b[31m,2,3,4,5,6\n"),
               {"line 2", "column ax", "'??[31m'"}}),
    [](const auto& instance) { return instance.param.name; });

TEST(SampleCsv, NamesAMissingFileAndAFolder) {
  const Scratch scratch;
  EXPECT_NE(complaint_about(scratch.path() / "nowhere.csv").find("nowhere.csv: cannot be read"),
            std::string::npos);
  EXPECT_NE(complaint_about(scratch.path()).find("is a folder"), std::string::npos);
}

TEST(SampleCsv, ReadsGzipAndRefusesItTruncated) {
  const Scratch scratch;
  std::string text = kHeader;
  for (int i = 0; i < 20000; ++i)
    text += std::to_string(1000 * (i + 1)) + ",0.1,0.2,-9.8," + std::to_string(i * 0.01) + ",0,0\n";
  const auto file = scratch.path() / "s.csv.gz";
  gzFile gz = gzopen(file.c_str(), "wb");
  gzwrite(gz, text.data(), static_cast<unsigned>(text.size()));
  gzclose(gz);
  EXPECT_EQ(read_all(file), 20000);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) * 2 / 3);
  const std::string said = complaint_about(file);
  EXPECT_NE(said.find("end too early"), std::string::npos) << said;
}

TEST(SampleCsv, ComesBackAsItWasWritten) {
  const Scratch scratch;
  const auto file = scratch.path() / "out.csv";
  estimator::ImuSample s;
  s.f_B = {0.1, 1.0 / 3, -9.80665};
  s.w_NB_B = {1e-9, -2.5, 0};
  s.m_B_uT = {20, -15.822, 38};
  s.temperature_degC = 21.25;
  {
    SampleCsvWriter writer(file, true, true);
    for (int i = 0; i < 3; ++i) {
      s.utime = 1'500'000'000'000'000 + i * 10'000;
      s.flags = i == 1 ? flag::kNoMagnetometer : 0;
      writer.write(s);
    }
    EXPECT_FALSE(std::filesystem::exists(file));
    writer.close();
  }
  SampleCsvReader reader(file);
  estimator::ImuSample back;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(reader.next(back));
    EXPECT_EQ(back.utime, 1'500'000'000'000'000 + i * 10'000);
    EXPECT_EQ(back.f_B, s.f_B);
    EXPECT_EQ(back.w_NB_B, s.w_NB_B);
    EXPECT_EQ(back.m_B_uT, i == 1 ? Vector3d(0, 0, 0) : s.m_B_uT);
    EXPECT_EQ(back.temperature_degC, 21.25);
  }
  EXPECT_FALSE(reader.next(back));
}

TEST(SampleCsv, LeavesNothingBehindWhereItIsNotClosed) {
  const Scratch scratch;
  { SampleCsvWriter writer(scratch.path() / "out.csv", false, false); }
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path()));
}

TEST(SampleCsv, ReadsARealRecording) {
  const auto file = recordings() / "broad10_translation.csv.gz";
  WAVERIG_NEEDS_RECORDING(file);
  SampleCsvReader reader(file);
  estimator::ImuSample s;
  std::int64_t first = 0, rows = 0, magnetic = 0;
  while (reader.next(s)) {
    first = rows++ == 0 ? s.utime : first;
    magnetic += (s.flags & flag::kNoMagnetometer) == 0;
  }
  EXPECT_GT(magnetic, 0);
  EXPECT_NEAR(static_cast<double>(s.utime - first) * 1e-6, 194, 1);
  EXPECT_NEAR(static_cast<double>(rows - 1) / (static_cast<double>(s.utime - first) * 1e-6), 285.7, 0.1);
}

TEST(HeaveCsv, ComesBackAsItWasWritten) {
  const Scratch scratch;
  HeaveCsvWriter writer(scratch.path() / "heave.csv");
  estimator::HeaveSample sample;
  sample.utime = 10;
  sample.heave_m = -0.1234567;
  writer.write(sample);
  sample.utime = 20;
  sample.heave_sigma_m = 0.02;
  writer.write(sample);
  writer.close();
  const HeaveSeries back = read_heave_csv(scratch.path() / "heave.csv");
  ASSERT_EQ(back.utime.size(), 2u);
  EXPECT_NEAR(back.heave_m[0], -0.1234567, 5e-7);
  EXPECT_TRUE(std::isnan(back.heave_sigma_m[0]));
  EXPECT_EQ(back.heave_sigma_m[1], 0.02);
  EXPECT_TRUE(back.moving.empty());
}

TEST(HeaveCsv, KeepsEmptyCellsAsUnknownAndReadsTheMovingColumn) {
  const Scratch scratch;
  const HeaveSeries s =
      read_heave_csv(scratch.write("truth.csv", "utime,heave_m,moving\n1,0.5,0\n2,,1\n3,nan,1\n"));
  EXPECT_EQ(s.heave_m[0], 0.5);
  EXPECT_TRUE(std::isnan(s.heave_m[1]));
  EXPECT_TRUE(std::isnan(s.heave_m[2]));
  EXPECT_EQ(s.moving, (std::vector<bool>{false, true, true}));
}

TEST(HeaveCsv, RefusesWhatCanBeNoHeaveNamingIt) {
  const Scratch scratch;
  const auto said = [&](const std::string& text) {
    try {
      read_heave_csv(scratch.write("h.csv", text));
    } catch (const UserError& error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  // Of times so far apart no difference is a whole number any more.
  EXPECT_NE(said("utime,heave_m\n0,1\n9223372036854775807,1\n").find("h.csv, line 3, column utime: '92233720"),
            std::string::npos);
  EXPECT_NE(said("utime,heave_m\n-9223372036854775808,1\n0,1\n").find("line 2, column utime: '-9223"),
            std::string::npos);
  EXPECT_EQ(said("utime,heave_m\n-1000000000000000000,1\n1000000000000000000,1\n"), "not refused");
  // What stands for no value in other people's files.
  for (const std::string value : {"9.96921e36", "-99999", "1e20"})
    EXPECT_NE(said("utime,heave_m\n0,1\n1,2\n3," + value + "\n").find("line 4, column heave_m: '" + value + "'"),
              std::string::npos)
        << value;
  EXPECT_EQ(said("utime,heave_m\n0,-9999\n"), "not refused");
  for (const std::string column : {"heave_m", "heave_sigma_m", "moving"})
    EXPECT_NE(said("utime,heave_m," + column + "," + column + "\n0,1,1,1\n")
                  .find("h.csv, line 1: column '" + column + "' is there twice"),
              std::string::npos);
  EXPECT_EQ(said("utime,heave_m,note,note\n0,1,1,1\n"), "not refused");
}

TEST(HeaveCsv, RefusesAForeignHeaderAndDisorder) {
  const Scratch scratch;
  EXPECT_THROW(read_heave_csv(scratch.write("a.csv", "t,heave\n1,2\n")), UserError);
  EXPECT_THROW(read_heave_csv(scratch.write("b.csv", "utime,heave_m\n2,1\n1,1\n")), UserError);
  EXPECT_THROW(read_heave_csv(scratch.write("c.csv", "utime,heave_m\n")), UserError);
}

TEST(WavesCsv, CombinesTheKnownContributions) {
  const Scratch scratch;
  estimator::Wave wave;
  wave.start_utime = 42;
  wave.period_s = 6;
  wave.height_m = 0.6;
  EXPECT_TRUE(std::isnan(combined_sigma_m(wave)));
  const estimator::Wave plain = wave;
  wave.noise_sigma_m = 0.003;
  wave.tilt_sigma_m = 0.004;
  EXPECT_NEAR(combined_sigma_m(wave), 0.005, 1e-12);
  write_waves_csv(scratch.path() / "waves.csv", std::vector{wave, plain});
  EXPECT_EQ(Scratch::read(scratch.path() / "waves.csv"),
            "start_utime,period_s,height_cm,sigma_cm\n42,6.0000,60.0000,0.5000\n42,6.0000,60.0000,\n");
}

}  // namespace
}  // namespace waverig::evaluation
