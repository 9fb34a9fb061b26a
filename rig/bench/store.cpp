#include "rig/bench/store.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

using Json = nlohmann::json;
constexpr int kSchemaVersion = 3;

constexpr const char* kSchema = R"(
CREATE TABLE run(title TEXT, procedure TEXT, version TEXT, files TEXT, instruments TEXT, started INTEGER,
                 simulated INTEGER, outcome TEXT, sequence TEXT);
CREATE TABLE step(sequence INTEGER PRIMARY KEY AUTOINCREMENT, idx INTEGER, attempt INTEGER, section TEXT, path TEXT,
                  what TEXT, place TEXT, outcome INTEGER, message TEXT, started INTEGER, ended INTEGER, value REAL,
                  limits TEXT, UNIQUE(idx, attempt));
CREATE TABLE recording(idx INTEGER, attempt INTEGER, port TEXT, tags TEXT, start INTEGER, ticks INTEGER, clock INTEGER,
                       reference INTEGER, frames INTEGER, lost INTEGER, broken INTEGER, temperature REAL,
                       temperature_span REAL, channels TEXT, data BLOB, PRIMARY KEY(idx, attempt, port));
CREATE TABLE trace(port TEXT, utime INTEGER, raw BLOB, PRIMARY KEY(port, utime));
CREATE TABLE state(id INTEGER PRIMARY KEY CHECK(id = 0), utime INTEGER, world BLOB, frames TEXT);
)";

std::string json_of(const std::map<std::string, std::string>& map) { return Json(map).dump(); }
std::map<std::string, std::string> map_of(const std::string& text) {
  return Json::parse(text).get<std::map<std::string, std::string>>();
}

std::string json_of(const std::vector<ChannelCounts>& channels) {
  Json list = Json::array();
  for (const ChannelCounts& c : channels) list.push_back({c.channel, c.N, c.P, c.noise_A_sqrt_s});
  return list.dump();
}

std::vector<ChannelCounts> channels_of(const std::string& text) {
  std::vector<ChannelCounts> channels;
  for (const Json& c : Json::parse(text)) channels.push_back({c.at(0), c.at(1), c.at(2), c.at(3)});
  return channels;
}

}  // namespace

const char* name_of(StepOutcome outcome) {
  switch (outcome) {
    case StepOutcome::kDone:
      return "done";
    case StepOutcome::kFailed:
      return "failed";
    case StepOutcome::kAccepted:
      return "failed, went on";
    case StepOutcome::kMadeSafe:
      return "made safe";
  }
  return "";
}

namespace {

[[noreturn]] void refuse(sqlite3* database) {
  const std::string file = sqlite3_db_filename(database, "main"), why = sqlite3_errmsg(database);
  const int result = sqlite3_errcode(database) & 0xff;  // without what extends it
  if (result == SQLITE_FULL || result == SQLITE_IOERR || result == SQLITE_NOMEM)
    throw std::runtime_error(fmt::format("{}: not everything could be written: {}", file, why));
  throw UserError(fmt::format("{}: {}: expected a bench store", file, why));
}

}  // namespace

// One prepared statement; columns and parameters in order.
struct Store::Statement {
  Statement(sqlite3* database, const char* sql) : database_(database) {
    if (sqlite3_prepare_v2(database, sql, -1, &statement_, nullptr) != SQLITE_OK) fail();
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  [[noreturn]] void fail() const { refuse(database_); }
  Statement& bind(std::int64_t v) {
    return sqlite3_bind_int64(statement_, ++parameter_, v) == SQLITE_OK ? *this : (fail(), *this);
  }
  Statement& bind(double v) {
    return sqlite3_bind_double(statement_, ++parameter_, v) == SQLITE_OK ? *this : (fail(), *this);
  }
  Statement& bind(const std::string& v) {
    if (sqlite3_bind_text(statement_, ++parameter_, v.data(), static_cast<int>(v.size()), SQLITE_TRANSIENT) !=
        SQLITE_OK)
      fail();
    return *this;
  }
  Statement& bind_blob(const void* data, std::size_t size) {
    if (sqlite3_bind_blob64(statement_, ++parameter_, data, size, SQLITE_TRANSIENT) != SQLITE_OK) fail();
    return *this;
  }
  Statement& bind_null() {
    sqlite3_bind_null(statement_, ++parameter_);
    return *this;
  }
  // False after the last row.
  bool step() {
    const int result = sqlite3_step(statement_);
    if (result != SQLITE_ROW && result != SQLITE_DONE) fail();
    column_ = 0;
    return result == SQLITE_ROW;
  }
  std::int64_t integer() { return sqlite3_column_int64(statement_, column_++); }
  double real() { return sqlite3_column_double(statement_, column_++); }
  std::string text() {
    const int size = sqlite3_column_bytes(statement_, column_);
    const auto* data = static_cast<const char*>(sqlite3_column_blob(statement_, column_++));
    return data == nullptr ? std::string() : std::string(data, static_cast<std::size_t>(size));
  }
  bool null() const { return sqlite3_column_type(statement_, column_) == SQLITE_NULL; }
  void skip() { ++column_; }

  sqlite3* database_;
  sqlite3_stmt* statement_ = nullptr;
  int parameter_ = 0, column_ = 0;
};

namespace {

sqlite3* open_database(const std::filesystem::path& file, int flags) {
  sqlite3* database = nullptr;
  if (sqlite3_open_v2(file.c_str(), &database, flags, nullptr) != SQLITE_OK) {
    const std::string why = database != nullptr ? sqlite3_errmsg(database) : "out of memory";
    sqlite3_close(database);
    throw UserError(fmt::format("{}: {}: expected a bench store", file.string(), why));
  }
  sqlite3_busy_timeout(database, 10'000);
  return database;
}

}  // namespace

void Store::execute(const char* sql) const {
  if (sqlite3_exec(database_, sql, nullptr, nullptr, nullptr) != SQLITE_OK) refuse(database_);
}

bool Store::begun(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return false;
  Store store(open_database(file, SQLITE_OPEN_READWRITE));
  Statement made(store.database_,
                 "SELECT user_version <> 0 OR EXISTS(SELECT * FROM sqlite_master) FROM pragma_user_version");
  return made.step() && made.integer() != 0;
}

// Whole under its own name or not at all: what a kill leaves behind has another name, and the next takes its
// place.
Store Store::create(const std::filesystem::path& file, const RunInfo& info) {
  if (begun(file))
    throw UserError(
        fmt::format("{}: a run is there already: expected another directory, or --resume", file.string()));
  const std::filesystem::path partial = file.string() + ".partial";
  // A journal of another file would be played into the new one.
  for (const char* rest :
       {".partial", ".partial-journal", ".partial-wal", ".partial-shm", "-journal", "-wal", "-shm"})
    std::filesystem::remove(file.string() + rest);
  {
    Store store(open_database(partial, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE));
    store.execute("PRAGMA synchronous = FULL; BEGIN IMMEDIATE;");
    store.execute(kSchema);
    store.execute(fmt::format("PRAGMA user_version = {};", kSchemaVersion).c_str());
    Statement(store.database_, "INSERT INTO run VALUES(?,?,?,?,?,?,?,?,?)")
        .bind(info.title)
        .bind(info.procedure)
        .bind(info.version)
        .bind(json_of(info.files))
        .bind(json_of(info.instruments))
        .bind(info.started_utime)
        .bind(std::int64_t{info.simulated})
        .bind(info.outcome)
        .bind(info.sequence)
        .step();
    store.execute("COMMIT; PRAGMA journal_mode = WAL;");
  }
  rename_whole(partial, file);
  return open(file);
}

Store Store::open(const std::filesystem::path& file) {
  if (!begun(file))
    throw UserError(fmt::format("{}: no run is there: expected a bench store", file.string()));
  Store store(open_database(file, SQLITE_OPEN_READWRITE));
  Statement version(store.database_, "PRAGMA user_version");
  if (!version.step() || version.integer() != kSchemaVersion)
    throw UserError(fmt::format("{}: expected a bench store of version {}", file.string(), kSchemaVersion));
  store.execute("PRAGMA synchronous = FULL;");
  return store;
}

Store::Store(Store&& other) noexcept : database_(std::exchange(other.database_, nullptr)) {}
Store::~Store() { sqlite3_close(database_); }

void Store::commit(const StepRow& s, const std::vector<RecordingRow>& recordings,
                   const std::vector<TraceRow>& trace, const ResumeState& state) {
  execute("BEGIN IMMEDIATE;");
  try {
    Statement step(
        database_,
        "INSERT INTO step(idx,attempt,section,path,what,place,outcome,message,started,ended,value,limits)"
        " VALUES(?,?,?,?,?,?,?,?,?,?,?,?)");
    step.bind(std::int64_t{s.index})
        .bind(std::int64_t{s.attempt})
        .bind(s.section)
        .bind(s.path)
        .bind(s.what)
        .bind(s.where)
        .bind(static_cast<std::int64_t>(s.outcome))
        .bind(s.message)
        .bind(s.started_utime)
        .bind(s.ended_utime);
    (s.value ? step.bind(*s.value) : step.bind_null()).bind(s.limits).step();
    for (const RecordingRow& r : recordings) {
      Statement recording(database_, "INSERT INTO recording VALUES(?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
      recording.bind(std::int64_t{r.index})
          .bind(std::int64_t{r.attempt})
          .bind(r.port)
          .bind(json_of(r.tags))
          .bind(r.start_utime)
          .bind(r.ticks)
          .bind(r.clock)
          .bind(r.reference)
          .bind(r.frames)
          .bind(r.lost)
          .bind(r.broken)
          .bind(r.temperature)
          .bind(r.temperature_span)
          .bind(json_of(r.channels))
          .bind_blob(r.data.data(), r.data.size())
          .step();
    }
    for (const TraceRow& t : trace)
      Statement(database_, "INSERT OR REPLACE INTO trace VALUES(?,?,?)")
          .bind(t.port)
          .bind(t.utime)
          .bind_blob(t.raw.data(), t.raw.size() * sizeof t.raw.front())
          .step();
    Statement(database_, "INSERT OR REPLACE INTO state VALUES(0,?,?,?)")
        .bind(state.utime)
        .bind_blob(state.world.data(), state.world.size())
        .bind(Json(state.last_frames).dump())
        .step();
    execute("COMMIT;");
  } catch (...) {
    sqlite3_exec(database_, "ROLLBACK;", nullptr, nullptr, nullptr);
    throw;
  }
}

void Store::set_instruments(const std::map<std::string, std::string>& instruments) {
  Statement(database_, "UPDATE run SET instruments = ?").bind(json_of(instruments)).step();
}

void Store::set_outcome(const std::string& outcome) {
  Statement(database_, "UPDATE run SET outcome = ?").bind(outcome).step();
}

RunInfo Store::info() const {
  Statement row(
      database_,
      "SELECT title,procedure,version,files,instruments,started,simulated,outcome,sequence FROM run");
  if (!row.step()) throw UserError("bench store: it holds no run");
  RunInfo info;
  info.title = row.text();
  info.procedure = row.text();
  info.version = row.text();
  info.files = map_of(row.text());
  info.instruments = map_of(row.text());
  info.started_utime = row.integer();
  info.simulated = row.integer() != 0;
  info.outcome = row.text();
  info.sequence = row.text();
  return info;
}

ResumeState Store::resume_state() const {
  ResumeState state;
  Statement row(database_, "SELECT utime,world,frames FROM state");
  if (!row.step()) return state;
  state.utime = row.integer();
  state.world = row.text();
  state.last_frames = Json::parse(row.text()).get<decltype(state.last_frames)>();
  return state;
}

std::vector<StepRow> Store::steps() const {
  std::vector<StepRow> rows;
  Statement row(database_,
                "SELECT idx,attempt,section,path,what,place,outcome,message,started,ended,value,limits"
                " FROM step ORDER BY sequence");
  while (row.step()) {
    StepRow& s = rows.emplace_back();
    s.index = static_cast<int>(row.integer());
    s.attempt = static_cast<int>(row.integer());
    s.section = row.text();
    s.path = row.text();
    s.what = row.text();
    s.where = row.text();
    s.outcome = static_cast<StepOutcome>(row.integer());
    s.message = row.text();
    s.started_utime = row.integer();
    s.ended_utime = row.integer();
    if (!row.null())
      s.value = row.real();
    else
      row.skip();
    s.limits = row.text();
  }
  return rows;
}

std::vector<TraceRow> Store::trace() const {
  std::vector<TraceRow> rows;
  Statement row(database_, "SELECT port,utime,raw FROM trace ORDER BY utime,port");
  while (row.step()) {
    TraceRow& t = rows.emplace_back();
    t.port = row.text();
    t.utime = row.integer();
    const std::string bytes = row.text();
    t.raw.resize(bytes.size() / sizeof t.raw.front());
    std::memcpy(t.raw.data(), bytes.data(), t.raw.size() * sizeof t.raw.front());
  }
  return rows;
}

std::vector<RecordingRow> Store::recordings(bool with_data) const {
  std::vector<RecordingRow> rows;
  Statement row(database_,
                "SELECT idx,attempt,port,tags,start,ticks,clock,reference,frames,lost,broken,temperature,"
                "temperature_span,channels,data FROM recording ORDER BY idx,attempt,port");
  while (row.step()) {
    RecordingRow& r = rows.emplace_back();
    r.index = static_cast<int>(row.integer());
    r.attempt = static_cast<int>(row.integer());
    r.port = row.text();
    r.tags = map_of(row.text());
    r.start_utime = row.integer();
    r.ticks = row.integer();
    r.clock = row.integer();
    r.reference = row.integer();
    r.frames = row.integer();
    r.lost = row.integer();
    r.broken = row.integer();
    r.temperature = row.real();
    r.temperature_span = row.real();
    r.channels = channels_of(row.text());
    if (with_data) {
      const std::string data = row.text();
      r.data.assign(data.begin(), data.end());
    }
  }
  return rows;
}

}  // namespace waverig::rig::bench
