// The memory of a batch: a SQLite file with one row for each input.
//
// Each shard has a file of its own, which it locks as long as it runs. So no two machines write one file at a time, and
// nothing depends on shared memory across machines, which network file systems do not have. Other shards, and the
// report, read the file once its owner has ended. Locks must hold on all machines that share the folder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/batch/batch_row.h"

struct sqlite3;

namespace gim {

class Manifest {
  public:
    // Opens the file for one process alone, and makes it if it is missing. A kill at any time leaves it whole; all that
    // was put before is there.
    static Result<Manifest> open(const std::string& path);
    // Opens an existing file for reading. Nothing if a process has it open.
    static Result<std::optional<Manifest>> open_to_read(const std::string& path);

    // Writes the row in place of the old one with that name.
    Result<void> put(const BatchRow& row);
    // Writes all or none.
    Result<void> put_all(const std::vector<BatchRow>& rows);
    // In order of names.
    Result<std::vector<BatchRow>> rows() const;

  private:
    struct Close {
        void operator()(sqlite3* database) const;
    };
    explicit Manifest(sqlite3* database) : database_(database) {}
    static Result<Manifest> open_with(const std::string& path, int flags);
    Result<void> run(const std::string& sql);
    bool is_busy() const;
    Error failure(const std::string& what) const;

    std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace gim
