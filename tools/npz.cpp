#include "tools/npz.h"

#include <zip.h>

#include <memory>
#include <string_view>

#include "tools/npy.h"

namespace gim {
namespace {

constexpr std::string_view kExtension = ".npy";

Error error(std::string message) { return {Stage::kInput, std::move(message)}; }

struct Discard {
    void operator()(zip_t* archive) const { zip_discard(archive); }
    void operator()(zip_file_t* file) const { zip_fclose(file); }
};
using Archive = std::unique_ptr<zip_t, Discard>;

std::string text_of(zip_error_t* problem) {
    std::string text = zip_error_strerror(problem);
    zip_error_fini(problem);
    return text;
}

Result<Bytes> read_entry(zip_t* archive, zip_uint64_t index, MemoryBudget& memory) {
    zip_stat_t stat;
    if (zip_stat_index(archive, index, 0, &stat) != 0 || (stat.valid & ZIP_STAT_SIZE) == 0)
        return error("the .npz file is damaged");
    if (const Result<void> fits = memory.take(stat.size, 1, "an array"); !fits.ok()) return fits.error();
    const std::unique_ptr<zip_file_t, Discard> file(zip_fopen_index(archive, index, 0));
    if (!file) return error(std::string("the .npz file: ") + zip_strerror(archive));
    Bytes bytes(stat.size);
    const zip_int64_t read = zip_fread(file.get(), bytes.data(), bytes.size());
    uint8_t more = 0;  // at the end of the entry its checksum is compared
    if (read < 0 || static_cast<uint64_t>(read) != stat.size || zip_fread(file.get(), &more, 1) != 0)
        return error("the .npz file is damaged");
    return bytes;
}

}  // namespace

bool is_npz(std::span<const uint8_t> bytes) {
    return bytes.size() >= 4 && bytes[0] == 'P' && bytes[1] == 'K' && bytes[2] == 3 && bytes[3] == 4;
}

Result<std::vector<NamedArray>> read_npz(std::span<const uint8_t> bytes, MemoryBudget& memory) {
    zip_error_t problem;
    zip_error_init(&problem);
    zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &problem);
    const Archive archive(source ? zip_open_from_source(source, ZIP_RDONLY, &problem) : nullptr);
    if (!archive) {
        if (source) zip_source_free(source);
        return error("no .npz file: " + text_of(&problem));
    }
    std::vector<NamedArray> arrays;
    const zip_int64_t entries = zip_get_num_entries(archive.get(), 0);
    for (zip_int64_t i = 0; i < entries; ++i) {
        const char* entry = zip_get_name(archive.get(), static_cast<zip_uint64_t>(i), 0);
        std::string name = entry ? entry : "";
        if (!name.ends_with(kExtension)) continue;
        name.resize(name.size() - kExtension.size());
        const Result<Bytes> file = read_entry(archive.get(), static_cast<zip_uint64_t>(i), memory);
        if (!file.ok()) return file.error();
        Result<NumberArray> array = read_npy(file.value(), memory);
        if (!array.ok()) return error("'" + name + "': " + array.error().message);
        arrays.emplace_back(std::move(name), std::move(array.value()));
    }
    if (arrays.empty()) return error("the .npz file holds no array");
    return arrays;
}

Result<Bytes> write_npz(const std::vector<NamedArray>& arrays) {
    zip_error_t problem;
    zip_error_init(&problem);
    const auto failed = [&](const char* text) { return Error{Stage::kWrite, std::string("libzip: ") + text}; };
    zip_source_t* target = zip_source_buffer_create(nullptr, 0, 0, &problem);
    Archive archive(target ? zip_open_from_source(target, ZIP_TRUNCATE, &problem) : nullptr);
    if (!archive) {
        if (target) zip_source_free(target);
        return failed(text_of(&problem).c_str());
    }
    zip_source_keep(target);  // closing the archive must not free what it wrote
    const std::unique_ptr<zip_source_t, decltype(&zip_source_free)> kept(target, zip_source_free);
    std::vector<Bytes> files;
    for (const auto& [name, array] : arrays) files.push_back(write_npy(array));
    for (size_t i = 0; i < arrays.size(); ++i) {
        zip_source_t* source = zip_source_buffer(archive.get(), files[i].data(), files[i].size(), 0);
        const zip_int64_t index =
            source ? zip_file_add(archive.get(), (arrays[i].first + std::string(kExtension)).c_str(), source, 0) : -1;
        if (index < 0) {
            if (source) zip_source_free(source);
            return failed(zip_strerror(archive.get()));
        }
        constexpr zip_uint16_t kFirstDay = 0x21;  // 1980-01-01: the bytes must not tell when they were written
        if (zip_file_set_dostime(archive.get(), static_cast<zip_uint64_t>(index), 0, kFirstDay, 0) != 0)
            return failed(zip_strerror(archive.get()));
    }
    if (zip_close(archive.get()) != 0) return failed(zip_strerror(archive.get()));
    (void)archive.release();
    zip_stat_t stat;
    if (zip_source_stat(target, &stat) != 0 || zip_source_open(target) != 0) return failed("no bytes");
    Bytes bytes(stat.size);
    const zip_int64_t read = zip_source_read(target, bytes.data(), bytes.size());
    zip_source_close(target);
    if (read < 0 || static_cast<uint64_t>(read) != stat.size) return failed("no bytes");
    return bytes;
}

}  // namespace gim
