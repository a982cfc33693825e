// The output folder of a batch: its manifests, one for each shard, and the files that it should hold.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/batch/batch_list.h"
#include "tools/batch/batch_row.h"

namespace gim {

// "FOLDER/gim-batch-1-of-4.sqlite"
std::string manifest_path(const std::string& folder, uint32_t shard, uint32_t shards);
// Tells whether the manifest belongs to a batch of another number of shards.
bool is_of_other_split(const std::string& path, uint32_t shards);
std::string output_path(const std::string& folder, const std::string& name);
// "HOST:PROCESS"
std::string this_process();
double now_since_1970();  // seconds

using RowsByName = std::map<std::string, BatchRow>;

struct FolderRows {
    RowsByName rows;                  // of each name the row that changed last
    std::vector<std::string> busy;    // manifests that a process has open
    std::vector<std::string> broken;  // that cannot be read, with the reason
};
// Reads all manifests of the folder but `except`. Tries busy ones again for two seconds, because readers keep each
// other out for a moment.
FolderRows read_manifests(const std::string& folder, const std::string& except = {});

// Makes the row true after its process may have been killed at any moment: gives the finished file its name, or makes
// the row wait again.
void recover(BatchRow& row, const std::string& folder);

// Removes what killed runs began for these rows. All are recovered, and nothing runs for them.
void remove_unfinished(const std::vector<BatchRow>& rows, const std::string& folder);

// The output of the row is not there, or is none of ours.
void forget_output(BatchRow& row);

// Gives the finished file of the row its name, unless it has it. Fails if the output is not the one that the row tells.
Result<void> place_output(BatchRow& row, const std::string& folder);

}  // namespace gim
