#include "tools/batch/manifest.h"

#include <sqlite3.h>

#include <array>

namespace gim {
namespace {

constexpr int kFormat = 1;       // of the table, in the file's user_version
constexpr int kPatience = 2000;  // ms to wait for those who only read

constexpr const char* kTable =
    "CREATE TABLE IF NOT EXISTS files (name TEXT PRIMARY KEY, path TEXT NOT NULL, "
    "state TEXT NOT NULL CHECK (state IN ('waiting', 'running', 'done', 'failed')), "
    "hash TEXT, options TEXT, program TEXT, owner TEXT, since REAL, reason TEXT, partial TEXT, encodes INTEGER, "
    "input_bytes INTEGER, bytes INTEGER, triangles INTEGER, psnr REAL, max_error REAL, seconds REAL, folded INTEGER, "
    "layout TEXT, thumbnail BLOB) WITHOUT ROWID";

constexpr const char* kColumns =
    "name, path, state, hash, options, program, owner, since, reason, partial, encodes, input_bytes, bytes, triangles, "
    "psnr, max_error, seconds, folded, layout, thumbnail";

struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using Statement = std::unique_ptr<sqlite3_stmt, Finalize>;

// Values in the order of kColumns.
class Binder {
  public:
    explicit Binder(sqlite3_stmt* statement) : statement_(statement) {}
    void text(const std::string& value) {
        sqlite3_bind_text64(statement_, ++column_, value.data(), value.size(), SQLITE_TRANSIENT, SQLITE_UTF8);
    }
    void number(double value) { sqlite3_bind_double(statement_, ++column_, value); }
    void whole(uint64_t value) { sqlite3_bind_int64(statement_, ++column_, static_cast<sqlite3_int64>(value)); }
    void nothing() { sqlite3_bind_null(statement_, ++column_); }
    void blob(const Bytes& value) {
        sqlite3_bind_blob64(statement_, ++column_, value.data(), value.size(), SQLITE_TRANSIENT);
    }

  private:
    sqlite3_stmt* statement_;
    int column_ = 0;
};

class Columns {
  public:
    explicit Columns(sqlite3_stmt* statement) : statement_(statement) {}
    std::string text() {
        const void* const data = sqlite3_column_text(statement_, column_);
        const auto size = static_cast<size_t>(sqlite3_column_bytes(statement_, column_++));
        return data == nullptr ? std::string() : std::string(static_cast<const char*>(data), size);
    }
    double number() { return sqlite3_column_double(statement_, column_++); }
    uint64_t whole() { return static_cast<uint64_t>(sqlite3_column_int64(statement_, column_++)); }
    std::optional<double> number_or_nothing() {
        if (sqlite3_column_type(statement_, column_) != SQLITE_NULL) return number();
        ++column_;
        return {};
    }
    Bytes blob() {
        const auto* const data = static_cast<const uint8_t*>(sqlite3_column_blob(statement_, column_));
        const auto size = static_cast<size_t>(sqlite3_column_bytes(statement_, column_++));
        return data == nullptr ? Bytes() : Bytes(data, data + size);
    }

  private:
    sqlite3_stmt* statement_;
    int column_ = 0;
};

void bind(const BatchRow& row, Binder values) {
    values.text(row.name);
    values.text(row.path);
    values.text(name_of(row.state));
    values.text(row.recipe.hash);
    values.text(row.recipe.options);
    values.text(row.recipe.program);
    values.text(row.owner);
    values.number(row.since);
    values.text(row.reason);
    values.text(row.partial);
    values.whole(row.encodes);
    const BatchFigures& figures = row.figures;
    values.whole(figures.input_bytes);
    values.whole(figures.bytes);
    values.whole(figures.triangles);
    if (figures.psnr)
        values.number(*figures.psnr);
    else
        values.nothing();
    values.number(figures.max_error);
    values.number(figures.seconds);
    values.whole(figures.folded);
    values.text(figures.layout);
    values.blob(row.thumbnail);
}

BatchRow::State state_named(const std::string& name) {
    using State = BatchRow::State;
    for (const State state : {State::kRunning, State::kDone, State::kFailed}) {
        if (name == name_of(state)) return state;
    }
    return State::kWaiting;
}

BatchRow row_of(Columns columns) {
    BatchRow row;
    row.name = columns.text();
    row.path = columns.text();
    row.state = state_named(columns.text());
    row.recipe.hash = columns.text();
    row.recipe.options = columns.text();
    row.recipe.program = columns.text();
    row.owner = columns.text();
    row.since = columns.number();
    row.reason = columns.text();
    row.partial = columns.text();
    row.encodes = static_cast<uint32_t>(columns.whole());
    row.figures.input_bytes = columns.whole();
    row.figures.bytes = columns.whole();
    row.figures.triangles = columns.whole();
    row.figures.psnr = columns.number_or_nothing();
    row.figures.max_error = columns.number();
    row.figures.seconds = columns.number();
    row.figures.folded = columns.whole();
    row.figures.layout = columns.text();
    row.thumbnail = columns.blob();
    return row;
}

int format_of(sqlite3* database) {
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(database, "PRAGMA user_version", -1, &raw, nullptr) != SQLITE_OK) return -1;
    const Statement statement(raw);
    return sqlite3_step(raw) == SQLITE_ROW ? sqlite3_column_int(raw, 0) : -1;
}

}  // namespace

const char* name_of(BatchRow::State state) {
    constexpr std::array<const char*, 4> kNames = {"waiting", "running", "done", "failed"};
    return kNames[static_cast<size_t>(state)];
}

void Manifest::Close::operator()(sqlite3* database) const { sqlite3_close(database); }

bool Manifest::is_busy() const {
    const int code = sqlite3_errcode(database_.get());
    return code == SQLITE_BUSY || code == SQLITE_LOCKED;
}

Error Manifest::failure(const std::string& what) const {
    if (is_busy())
        return {Stage::kWrite, "another gim batch has the manifest of this shard open; wait until it ends, or stop it"};
    return {Stage::kWrite, what + ": " + sqlite3_errmsg(database_.get())};
}

Result<void> Manifest::run(const std::string& sql) {
    if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
        return failure("cannot use the manifest");
    return {};
}

Result<Manifest> Manifest::open_with(const std::string& path, int flags) {
    sqlite3* database = nullptr;
    const int code = sqlite3_open_v2(path.c_str(), &database, flags, nullptr);
    Manifest manifest(database);
    if (database == nullptr) return Error{Stage::kWrite, "cannot open the manifest: no memory is left"};
    if (code != SQLITE_OK) return manifest.failure("cannot open the manifest");
    return manifest;
}

Result<Manifest> Manifest::open(const std::string& path) {
    Result<Manifest> manifest = open_with(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
    if (!manifest.ok()) return manifest;
    sqlite3_busy_timeout(manifest.value().database_.get(), kPatience);
    // With the lock held all the time, the log needs no memory that processes share, so it works on any file system.
    for (const char* const sql : {"PRAGMA locking_mode = EXCLUSIVE", "PRAGMA journal_mode = WAL",
                                  "PRAGMA synchronous = NORMAL", "BEGIN IMMEDIATE"}) {
        const Result<void> done = manifest.value().run(sql);
        if (!done.ok()) return done.error();
    }
    const int format = format_of(manifest.value().database_.get());
    if (format != 0 && format != kFormat)
        return Error{Stage::kWrite, "another version of gim made this manifest; choose another output folder"};
    for (const std::string& sql :
         {std::string(kTable), "PRAGMA user_version = " + std::to_string(kFormat), std::string("COMMIT")}) {
        const Result<void> done = manifest.value().run(sql);
        if (!done.ok()) return done.error();
    }
    return manifest;
}

Result<std::optional<Manifest>> Manifest::open_to_read(const std::string& path) {
    // Reading needs to write too: what a killed owner left in the log moves into the file.
    Result<Manifest> opened = open_with(path, SQLITE_OPEN_READWRITE);
    if (!opened.ok()) return opened.error();
    Manifest& manifest = opened.value();
    if (Result<void> alone = manifest.run("PRAGMA locking_mode = EXCLUSIVE"); !alone.ok()) return alone.error();
    const int format = format_of(manifest.database_.get());
    if (manifest.is_busy()) return std::optional<Manifest>();
    if (format < 0) return manifest.failure("cannot read the manifest");
    if (format != kFormat) return Error{Stage::kInput, "this manifest is empty, or another version of gim made it"};
    return std::optional<Manifest>(std::move(manifest));
}

Result<void> Manifest::put(const BatchRow& row) {
    const std::string sql =
        std::string("INSERT OR REPLACE INTO files (") + kColumns + ") VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)";
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &raw, nullptr) != SQLITE_OK)
        return failure("cannot write the manifest");
    const Statement statement(raw);
    bind(row, Binder(raw));
    if (sqlite3_step(raw) != SQLITE_DONE) return failure("cannot write the manifest");
    return {};
}

Result<void> Manifest::put_all(const std::vector<BatchRow>& rows) {
    if (Result<void> begun = run("BEGIN IMMEDIATE"); !begun.ok()) return begun;
    for (const BatchRow& row : rows) {
        if (Result<void> put_one = put(row); !put_one.ok()) {
            (void)run("ROLLBACK");
            return put_one;
        }
    }
    return run("COMMIT");
}

Result<std::vector<BatchRow>> Manifest::rows() const {
    const std::string sql = std::string("SELECT ") + kColumns + " FROM files ORDER BY name";
    sqlite3_stmt* raw = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &raw, nullptr) != SQLITE_OK)
        return failure("cannot read the manifest");
    const Statement statement(raw);
    std::vector<BatchRow> rows;
    int code = 0;
    while ((code = sqlite3_step(raw)) == SQLITE_ROW) rows.push_back(row_of(Columns(raw)));
    if (code != SQLITE_DONE) return failure("cannot read the manifest");
    return rows;
}

}  // namespace gim
