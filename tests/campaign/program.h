// The program from outside: how tests run it and what they look at.
#pragma once
#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include "tests/campaign/temporary_directory.h"

namespace waverig {

struct Outcome {
  int status = -1;  // exit status as a shell has it; -1 where a signal ended it
  std::string out, err;
};

// Inside the directory, which keeps stdout and stderr.
inline Outcome run(const TemporaryDirectory& temporary, const std::string& arguments) {
  const std::string out = (temporary / "stdout").string(), err = (temporary / "stderr").string();
  const int status = std::system((std::string("cd ") + temporary.path().string() +
                                  " && " WAVERIG_PROGRAM " " + arguments + " >" + out + " 2>" + err)
                                     .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of(out), bytes_of(err)};
}

// Runs a command, waits for a file to be there, and ends the command by a signal: its exit status as a shell
// has it.
inline Outcome ended_early(const TemporaryDirectory& temporary, const std::string& arguments,
                           const std::string& file, const std::string& signal = "TERM") {
  temporary.write("end.sh", "cd '" + temporary.path().string() + "'\n" WAVERIG_PROGRAM " " + arguments +
                                " >stdout 2>stderr &\n"
                                "for i in $(seq 3000); do ls " +
                                file +
                                " >/dev/null 2>&1 && break; sleep 0.01; done\n"
                                "kill -" + signal + " $!\nwait $!\n");
  const int status = std::system(("sh " + (temporary / "end.sh").string() + " 2>/dev/null").c_str());
  return {WEXITSTATUS(status), bytes_of(temporary / "stdout"), bytes_of(temporary / "stderr")};
}

// A campaign of one run, as small as can be.
inline constexpr const char* kTiny =
    "name = \"tiny\"\n[sweep]\nperiods_s = [4.0]\nheights_cm = [50.0]\n"
    "duration_s = 30.0\nrepeats = 1\nramp_periods = 1\n";

// NaN where the key is not there.
inline double number_in(const std::string& json, const std::string& key) {
  const std::size_t at = json.find("\"" + key + "\":");
  return at == std::string::npos ? std::nan("") : std::stod(json.substr(at + key.size() + 3));
}

// A wave of 4 s and a metre as a level unit feels it.
inline std::string wave_record() {
  std::string text = "utime,ax,ay,az,gx,gy,gz\n";
  for (int row = 0; row < 12000; ++row)
    text += std::to_string(row * 10000) + ",0,0," +
            std::to_string(-9.80665 + 1.2337 * std::cos(2 * std::numbers::pi * row / 400)) + ",0,0,0\n";
  return text;
}

}  // namespace waverig
