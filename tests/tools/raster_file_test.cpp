// Images of other programs on their way through the tools: .npz and .exr, to a .gim file and back.
#include "tools/raster_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/encoder/raster/made_rasters.h"
#include "tests/tools/program.h"
#include "tests/tools/test_files.h"
#include "tools/commands.h"
#include "tools/npy.h"

namespace gim {
namespace {

using namespace gim::test;

constexpr SampleType kAllTypes[] = {SampleType::kFloat32, SampleType::kFloat64, SampleType::kFloat16,
                                    SampleType::kUint8,   SampleType::kInt8,    SampleType::kUint16,
                                    SampleType::kInt16,   SampleType::kUint32,  SampleType::kInt32};

Result<RasterImage> read_npz_image(const Bytes& bytes, const RasterOptions& options = {}) {
    MemoryBudget memory(1 << 26);
    return read_raster(bytes, RasterFormat::kNpz, options, memory);
}

std::string failure(const std::vector<NamedArray>& arrays, const RasterOptions& options = {}) {
    const Result<Bytes> bytes = write_npz(arrays);
    if (!bytes.ok()) return bytes.error().message;
    const Result<RasterImage> image = read_npz_image(bytes.value(), options);
    return image.ok() ? "" : image.error().message;
}

void expect_equal(const RasterImage& a, const RasterImage& b) {
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.channels, b.channels);
    EXPECT_EQ(a.type, b.type);
    EXPECT_EQ(a.is_channels_first, b.is_channels_first);
    EXPECT_EQ(a.mask, b.mask);
    EXPECT_EQ(a.mask_value, b.mask_value);
    ASSERT_EQ(a.defined, b.defined);
    for (size_t i = 0; i < a.values.size(); ++i) {
        if (!a.defined[i / a.channels]) continue;
        ASSERT_EQ(a.values[i], b.values[i]) << i;
    }
}

RasterImage small_numbers(SampleType type, uint32_t channels) {
    RasterImage image = raster_of(18, 13, with_holes, channels);
    image.type = type;
    for (double& v : image.values) v = std::floor(v / 40);
    return image;
}

// Encodes and decodes by the commands.
RasterImage through_gim(const RasterImage& image, RasterFormat format, const std::string& extension) {
    TemporaryFolder folder;
    const Result<Bytes> bytes = write_raster_file(image, format);
    EXPECT_TRUE(bytes.ok());
    save(folder.file("in" + extension), {reinterpret_cast<const char*>(bytes.value().data()), bytes.value().size()});
    EncodeCommand encode;
    encode.input = folder.file("in" + extension);
    encode.output = folder.file("a.gim");
    encode.quiet = true;
    encode.options.layout = Layout::kMcgim;
    encode.options.threads = 1;
    encode.options.rate = {RateTarget::Kind::kLossless, 0};
    EXPECT_EQ(run_encode(encode), 0);
    DecodeCommand decode;
    decode.input = encode.output;
    decode.output = folder.file("out" + extension);
    EXPECT_EQ(run_decode(decode), 0);
    const Result<Bytes> back = read_file(decode.output);
    EXPECT_TRUE(back.ok());
    MemoryBudget memory(1 << 26);
    Result<RasterImage> read = read_raster(back.value(), format, {}, memory);
    EXPECT_TRUE(read.ok()) << read.error().message;
    return read.ok() ? read.value() : RasterImage{};
}

TEST(RasterFile, EveryTypeAndMaskComesBackFromNpz) {
    for (const SampleType type : kAllTypes) {
        SCOPED_TRACE(static_cast<int>(type));
        for (const auto mask : {RasterImage::Mask::kArray, RasterImage::Mask::kChannel}) {
            for (const bool is_first : {false, true}) {
                RasterImage image = small_numbers(type, 4);
                image.mask = mask;
                image.is_channels_first = is_first;
                expect_equal(image, through_gim(image, RasterFormat::kNpz, ".npz"));
            }
        }
    }
    RasterImage holes = small_numbers(SampleType::kFloat64, 3);
    holes.mask = RasterImage::Mask::kNowhere;
    expect_equal(holes, through_gim(holes, RasterFormat::kNpz, ".npz"));
}

TEST(RasterFile, ExrComesBackWithItsNames) {
    for (const SampleType type : {SampleType::kFloat32, SampleType::kFloat16, SampleType::kUint32}) {
        SCOPED_TRACE(static_cast<int>(type));
        RasterImage image = small_numbers(type, 5);
        image.names = {"R", "G", "B", "nx", "ny"};
        const RasterImage back = through_gim(image, RasterFormat::kExr, ".exr");
        expect_equal(image, back);
        EXPECT_EQ(back.names, (std::vector<std::string>{"R", "G", "B", "nx", "ny", "mask"}));
    }
    RasterImage plain = small_numbers(SampleType::kFloat32, 3);
    expect_equal(plain, through_gim(plain, RasterFormat::kExr, ".exr"));
}

std::string saved(const TemporaryFolder& folder, const RasterImage& image) {
    const Result<Bytes> bytes = write_raster_file(image, RasterFormat::kNpz);
    EXPECT_TRUE(bytes.ok());
    save(folder.file("in.npz"), {reinterpret_cast<const char*>(bytes.value().data()), bytes.value().size()});
    return folder.file("in.npz");
}

TEST(RasterFile, InfoSaysOnlyWhatSuchFilesHave) {
    TemporaryFolder folder;
    const std::string input = saved(folder, raster_of(18, 13, with_holes, 4)), file = folder.file("a.gim");
    ASSERT_EQ(gim({"encode", input, file, "--lossless", "--quiet"}).status, 0);
    const Outcome text = gim({"info", file});
    EXPECT_EQ(text.status, 0);
    EXPECT_EQ(text.out.find("paths"), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("imported image: uint16, 4 channels and a mask"), std::string::npos) << text.out;
    const nlohmann::json image = nlohmann::json::parse(gim({"info", file, "--json"}).out)["images"][0];
    EXPECT_FALSE(image.contains("paths"));
    EXPECT_FALSE(image.contains("seam_points"));
    EXPECT_EQ(image["levels"][0]["width"], 18);
}

TEST(RasterFile, SamplesAreFittedToAMesh) {
    TemporaryFolder folder;
    RasterImage flat = raster_of(12, 12, all_defined, 3);
    flat.type = SampleType::kFloat32;
    std::string obj;
    for (uint32_t i = 0; i < 144; ++i) {
        flat.values[3 * i] = i % 12;
        flat.values[3 * i + 1] = i / 12;
        flat.values[3 * i + 2] = 0.25;
        obj += "v " + std::to_string(i % 12) + " " + std::to_string(i / 12) + " 1\n";
    }
    for (uint32_t i = 1; i < 132; ++i) {
        if (i % 12 != 0)
            obj += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " + std::to_string(i + 13) + " " +
                   std::to_string(i + 12) + "\n";
    }
    save(folder.file("mesh.obj"), obj);
    const std::string input = saved(folder, flat), file = folder.file("a.gim"), mesh = folder.file("mesh.obj");
    const Outcome run = gim({"encode", input, file, "--refit", mesh, "--lossless", "--json", folder.file("r.json")});
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json report = nlohmann::json::parse(load_text(folder.file("r.json")));
    EXPECT_EQ(report["refit"], mesh);
    EXPECT_EQ(report["input_triangles"], 242);
    EXPECT_LT(report["error"]["rms_to_reference"], 1e-3);  // corners may be cut
    // Headerless squares are fitted too.
    std::string raw;
    for (size_t k = 0; k < 3; ++k) {
        for (uint32_t row = 0; row < 9; ++row) {
            for (uint32_t column = 0; column < 9; ++column) {
                const float places[] = {1.375f * static_cast<float>(column), 1.375f * static_cast<float>(row), 0.25f};
                const float value = places[k];
                raw.append(reinterpret_cast<const char*>(&value), sizeof value);
            }
        }
    }
    save(folder.file("raw.gim"), raw);
    for (const char* target : {"--lossless", "--psnr=50"}) {
        const Outcome square = gim({"encode", folder.file("raw.gim"), file, "--refit", mesh, target, "--json", "-"});
        ASSERT_EQ(square.status, 0) << square.err;
        EXPECT_GT(nlohmann::json::parse(square.out)["error"]["psnr"], 50);
    }
}

TEST(RasterFile, WhatCannotBeFittedIsRefusedWithTheReason) {
    TemporaryFolder folder;
    const std::string input = saved(folder, raster_of(12, 12, all_defined, 3));
    const auto failure = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "encode");
        const Outcome run = gim(std::move(arguments));
        EXPECT_EQ(run.status, 1);
        return run.err;
    };
    const std::string out = folder.file("a.gim"), mesh = folder.file("mesh.obj");
    save(mesh, obj_text(corpus::sphere(3)));
    EXPECT_NE(failure({input, out, "--refit", folder.file("nowhere.obj")}).find("nowhere.obj"), std::string::npos);
    EXPECT_NE(failure({input, out, "--refit", mesh}).find("same coordinates"), std::string::npos);
    EXPECT_NE(failure({mesh, out, "--refit", input}).find("this is an image"), std::string::npos);
    EXPECT_NE(failure({mesh, out, "--refit", folder.file("mesh.obj")}).find("--refit fits an image"),
              std::string::npos);
    EXPECT_NE(failure({input, folder.file("a.glb"), "--refit", mesh}).find("--refit belongs to"), std::string::npos);
    save(folder.file("empty.obj"), "");
    EXPECT_NE(failure({input, out, "--refit", folder.file("empty.obj")}), "");
}

TEST(RasterFile, AnotherMaskChannelCanBeNamed) {
    RasterImage image = small_numbers(SampleType::kUint16, 4);
    image.mask = RasterImage::Mask::kChannel;
    image.mask_channel = 0;
    image.mask_value = 65535;
    const Result<Bytes> bytes = write_raster_file(image, RasterFormat::kNpz);
    ASSERT_TRUE(bytes.ok());
    RasterOptions options;
    options.mask_channel = 0;
    const Result<RasterImage> back = read_npz_image(bytes.value(), options);
    ASSERT_TRUE(back.ok()) << back.error().message;
    expect_equal(image, back.value());
    options = {};
    options.no_mask = true;
    EXPECT_EQ(read_npz_image(bytes.value(), options).value().channels, 5u);
}

NumberArray array_of(std::vector<uint64_t> shape, double value = 1) {
    NumberArray array;
    array.type = SampleType::kUint16;
    array.shape = std::move(shape);
    uint64_t count = 1;
    for (const uint64_t n : array.shape) count *= n;
    array.values.assign(count, value);
    return array;
}

TEST(RasterFile, WhatIsNoImageIsRefusedWithTheReason) {
    EXPECT_NE(failure({{"mask", array_of({4, 4})}}).find("0 arrays"), std::string::npos);
    EXPECT_NE(failure({{"a", array_of({4, 4, 3})}, {"b", array_of({4, 4, 3})}}).find("2 arrays"), std::string::npos);
    EXPECT_NE(failure({{"a", array_of({4, 4})}}).find("4 x 4; an image has"), std::string::npos);
    EXPECT_NE(failure({{"a", array_of({2, 8, 8, 3})}}).find("2 x 8 x 8 x 3"), std::string::npos);
    EXPECT_NE(failure({{"a", array_of({5, 9, 5})}}).find("--channels"), std::string::npos);
    EXPECT_NE(failure({{"a", array_of({8, 8, 3})}, {"mask", array_of({8, 7})}}).find("the mask has the shape 8 x 7"),
              std::string::npos);
    NumberArray two = array_of({8, 8, 4});
    two.values[3] = 2;
    EXPECT_NE(failure({{"a", two}}).find("--mask-channel"), std::string::npos);
    RasterOptions options;
    options.mask_channel = 9;
    EXPECT_NE(failure({{"a", array_of({8, 8, 4})}}, options).find("no channel 9"), std::string::npos);
}

Bytes npy_of(const std::string& description, const Bytes& numbers) {
    Bytes bytes = {0x93, 'N', 'U', 'M', 'P', 'Y', 1, 0, static_cast<uint8_t>(description.size()), 0};
    bytes.insert(bytes.end(), description.begin(), description.end());
    bytes.insert(bytes.end(), numbers.begin(), numbers.end());
    return bytes;
}

TEST(Npy, FortranOrderAndBigEndianAreRead) {
    MemoryBudget memory(1 << 20);
    const Result<NumberArray> array = read_npy(
        npy_of("{'descr': '>u2', 'fortran_order': True, 'shape': (2, 3), }\n", {0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 1, 6}),
        memory);
    ASSERT_TRUE(array.ok()) << array.error().message;
    EXPECT_EQ(array.value().values, (std::vector<double>{1, 3, 5, 2, 4, 262}));
}

TEST(Npy, WhatIsNoPlainArrayIsRefused) {
    const auto message = [](const Bytes& bytes, uint64_t most = 1 << 20) {
        MemoryBudget memory(most);
        const Result<NumberArray> array = read_npy(bytes, memory);
        return array.ok() ? std::string() : array.error().message;
    };
    const auto described = [&](const std::string& descr) {
        return message(
            npy_of("{'descr': " + descr + ", 'fortran_order': False, 'shape': (1,), }", {0, 0, 0, 0, 0, 0, 0, 0}));
    };
    EXPECT_NE(described("'|O'").find("Python objects"), std::string::npos);
    EXPECT_NE(described("'<c8'").find("'<c8'"), std::string::npos);
    EXPECT_NE(described("'<i8'").find("'<i8'"), std::string::npos);
    EXPECT_NE(described("[('x', '<f4')]").find("structures"), std::string::npos);
    EXPECT_NE(described("'<u2'").find("as its shape says"), std::string::npos);
    EXPECT_EQ(described("'<f8'"), "");
    EXPECT_NE(message({1, 2, 3}).find("does not begin"), std::string::npos);
    EXPECT_NE(message(npy_of("{'descr': '<u2', 'shape': (1,), }", {0, 0})).find("broken"), std::string::npos);
    const std::string huge = "{'descr': '<u2', 'fortran_order': False, 'shape': (99999999, 99999999, 99999999), }";
    EXPECT_NE(message(npy_of(huge, {0, 0})).find("too large"), std::string::npos);
    Bytes cut = npy_of("{'descr': '<u2', 'fortran_order': False, 'shape': (1,), }", {0, 0});
    for (size_t n = 0; n < cut.size(); ++n)
        EXPECT_NE(message({cut.begin(), cut.begin() + static_cast<ptrdiff_t>(n)}), "");
    EXPECT_NE(message(cut, 4).find("memory"), std::string::npos);
}

TEST(Npz, DamagedFilesAreRefused) {
    const Result<Bytes> bytes = write_npz({{"image", array_of({8, 8, 3})}});
    ASSERT_TRUE(bytes.ok());
    EXPECT_EQ(write_npz({{"image", array_of({8, 8, 3})}}).value(), bytes.value());
    MemoryBudget memory(1 << 24);
    for (size_t n = 0; n < bytes.value().size(); n += 7)
        EXPECT_FALSE(read_npz(std::span(bytes.value()).first(n), memory).ok()) << n;
    Bytes damaged = bytes.value();
    damaged[60] ^= 1;
    EXPECT_FALSE(read_npz(damaged, memory).ok());
}

}  // namespace
}  // namespace gim
