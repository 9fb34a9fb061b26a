// The results directory of a campaign. Work goes on in DIR.partial, which becomes DIR in one rename when
// everything is there: a partial result is never mistaken for a finished one, and a finished one is replaced
// only by a finished one.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "estimator/evaluation/results_files.h"
#include "rig/campaign/directory_lock.h"

namespace waverig::rig {

class ResultsDirectory {
 public:
  enum class Mode { kFresh, kResume, kReplace };

  // kFresh refuses where DIR exists or a DIR.partial waits; kResume goes on in DIR.partial (or begins it),
  // beside an earlier DIR too where kReplace was interrupted; kReplace begins anew. An existing DIR stands
  // until finish(), and is replaced where it holds results alone: a file, or a folder of anything else, is
  // nobody's to remove. `resumes`: the command knows --resume. Throws UserError naming --out, also where
  // another process is at work in DIR.partial.
  ResultsDirectory(const std::filesystem::path& directory, Mode mode, bool resumes = true);
  ~ResultsDirectory();  // without finish() DIR.partial stays for --resume, or goes where there is none
  ResultsDirectory(const ResultsDirectory&) = delete;
  ResultsDirectory& operator=(const ResultsDirectory&) = delete;

  const std::filesystem::path& working() const { return working_; }
  std::filesystem::path runs() const { return evaluation::runs_of(working_); }
  std::filesystem::path figures() const { return working_ / "figures"; }

  // The settings that the directory belongs to, as resolved text, under a line with the version that makes
  // it: written when fresh, compared when resumed. Throws UserError where a resumed directory holds other
  // settings, or runs of another version.
  void claim(const std::string& resolved_settings, const std::string& version);
  void finish();

 private:
  void lock();

  std::filesystem::path directory_, place_, working_;  // as it was named; where it is
  std::optional<DirectoryLock> lock_;                  // of working_
  bool resumes_, finished_ = false;
};

// A campaign judged into another directory: settings, calibrations and logs come with it, so that figures,
// report and compare take that directory as they take the first.
void refuse_other_campaign(const std::filesystem::path& from, const std::filesystem::path& to);  // UserError
void take_campaign(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace waverig::rig
