#include <algorithm>

#include "estimator/evaluation/results_fields.h"
#include "estimator/evaluation/results_files.h"
#include "estimator/evaluation/results_io.h"
#include "lcmtypes/atomic_file.h"
#include "lcmtypes/disk.h"

namespace waverig::evaluation {
namespace {

using json::Json;

template <class Structure>
std::string line_of(const Structure& structure) {
  Json object = Json::object();
  json::Writer writer(object);
  fields(writer, structure);
  return object.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// results.json as text: an object of the campaign, with a line a cell and a line a run.
class JsonFile {
 public:
  JsonFile(const std::filesystem::path& path, const CampaignResults& head) : file_(path) {
    Json object = Json::object();
    json::Writer writer(object);
    head_fields(writer, head);
    // The calibration's report is JSON itself: kept as such, not as a string within a string.
    object["calibration"] =
        head.calibration_json.empty() ? Json(nullptr) : Json::parse(head.calibration_json);
    std::string text = object.dump(1, ' ', false, Json::error_handler_t::replace);
    text.resize(text.size() - 2);  // the closing brace: cells and runs follow
    file_.write(text);
  }
  void begin_array(const char* key) {
    file_.write(fmt::format(",\n \"{}\": [", key));
    first_ = true;
  }
  void element(std::string_view line) {
    file_.write(first_ ? "\n  " : ",\n  ");
    file_.write(line);
    first_ = false;
  }
  void end_array() { file_.write("\n ]"); }
  void flush() {
    file_.write("\n}\n");
    file_.flush();
  }
  void commit() { file_.commit(); }

 private:
  AtomicFile file_;
  bool first_ = true;
};

Json parsed(const std::filesystem::path& path) {
  const std::string all = content_of(path, "the results of a finished campaign");
  try {
    return Json::parse(all);
  } catch (const Json::parse_error& error) {
    const auto end = all.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, all.size()));
    throw UserError(fmt::format("{}, line {}: not valid JSON; expected the results of a campaign",
                                path.string(), std::count(all.begin(), end, '\n') + 1));
  }
}

// Both files of head and its cells. each_run calls its argument with the line of every run.
template <class EachRun>
void write_files(const std::filesystem::path& directory, const CampaignResults& head, EachRun each_run) {
  AtomicFile table(directory / kResultsTable);
  table.write(results_csv(head.cells));
  JsonFile file(directory / kResultsFile, head);
  file.begin_array("cells");
  for (const CellResult& cell : head.cells) file.element(line_of(cell));
  file.end_array();
  file.begin_array("runs");
  each_run([&file](std::string_view line) { file.element(line); });
  file.end_array();
  table.flush();
  file.flush();
  table.commit();
  file.commit();
}

}  // namespace

// Where a run stands in the journal, and what it is sorted by.
struct ResultsWriter::Entry {
  RunResult key;  // without waves and statistics
  long offset;
  std::size_t size;
};

ResultsWriter::ResultsWriter(std::filesystem::path directory)
    : directory_(std::move(directory)), journal_path_(directory_ / "results.journal.partial") {
  invalidate_results(directory_);
  journal_ = std::fopen(journal_path_.c_str(), "w+b");
  if (journal_ == nullptr)
    throw UserError(
        fmt::format("{}: cannot be written; expected an existing, writable directory", directory_.string()));
}

ResultsWriter::~ResultsWriter() {
  std::fclose(journal_);
  std::error_code ignored;
  std::filesystem::remove(journal_path_, ignored);
}

void ResultsWriter::add(const RunResult& run) {
  const std::string line = line_of(run);
  Entry entry{{}, std::ftell(journal_), line.size()};
  entry.key.run = run.run;
  entry.key.method = run.method;
  entry.key.repeat = run.repeat;
  entry.key.period_s = run.period_s;
  entry.key.height_m = run.height_m;
  if (std::fwrite(line.data(), 1, line.size(), journal_) != line.size())
    throw std::runtime_error(fmt::format("{}: not everything could be written", journal_path_.string()));
  entries_.push_back(std::move(entry));
}

CampaignResults ResultsWriter::finish(CampaignResults head, std::size_t waves_in_memory) {
  std::sort(entries_.begin(), entries_.end(),
            [](const Entry& a, const Entry& b) { return earlier(a.key, b.key); });
  std::string line;
  const auto read = [&](const Entry& entry) {
    line.resize(entry.size);
    if (std::fseek(journal_, entry.offset, SEEK_SET) != 0 ||
        std::fread(line.data(), 1, line.size(), journal_) != line.size())
      throw std::runtime_error(fmt::format("{}: cannot be read back", journal_path_.string()));
  };
  // Once for the cells, which stand first in the file, once for the runs themselves.
  head.runs.clear();
  CellPooling pooling;
  for (const Entry& entry : entries_) {
    read(entry);
    const Json object = Json::parse(line);
    json::Reader reader(object, journal_path_.string());
    RunResult run;
    fields(reader, run);
    pooling.add(run);
    if (run.waves.size() > waves_in_memory) run.waves = {};
    waves_in_memory -= run.waves.size();
    head.runs.push_back(std::move(run));
  }
  head.cells = pooling.finish();
  write_files(directory_, head, [&](auto take) {
    for (const Entry& entry : entries_) {
      read(entry);
      take(line);
    }
  });
  return head;
}

void write_results(const std::filesystem::path& directory, const CampaignResults& results) {
  write_files(directory, results, [&](auto take) {
    for (const RunResult& run : results.runs) take(line_of(run));
  });
}

void invalidate_results(const std::filesystem::path& directory) {
  for (const char* file : {kResultsFile, kResultsTable}) {
    std::error_code error;
    std::filesystem::remove(directory / file, error);
    if (error)
      throw UserError(fmt::format("{}: cannot be written: {}; expected a writable directory",
                                  (directory / file).string(), error.message()));
  }
}

CampaignResults read_results(const std::filesystem::path& directory) {
  const std::filesystem::path path = directory / kResultsFile;
  const Json object = parsed(path);
  json::Reader reader(object, path.string());
  CampaignResults results;
  head_fields(reader, results);
  reader("cells", results.cells);
  reader("runs", results.runs);
  tell_scatter(results.cells, results.runs);
  if (!results.complete)
    throw UserError(fmt::format("{}: key 'complete' is false; expected a finished campaign", path.string()));
  const auto calibration = object.find("calibration");
  if (calibration != object.end() && !calibration->is_null()) results.calibration_json = calibration->dump(1);
  return results;
}

}  // namespace waverig::evaluation
