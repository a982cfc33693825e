// gim::encoder: triangle mesh in, .gim file out. C++20. Nothing here throws, prints or exits; failures return an Error.
// All functions are pure: the same input, options and seed give the same result at any thread count.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace gim {

// Every change to the bytes of any file raises this number. Rows of corpus/results.csv from an older coder are then
// measured again.
inline constexpr uint32_t kCoderVersion = 5;

// The stage that reports progress or failed. `stage_name` returns the word that messages use.
enum class Stage { kInput, kClean, kCut, kBoundaryMap, kParametrize, kSample, kFit, kPlanes, kCode, kWrite, kCompare };
std::string_view stage_name(Stage stage);

struct Error {
    Stage stage = Stage::kInput;
    std::string message;        // one or more lines: which element, what is wrong with it, and what to do
    bool is_cancelled = false;  // nothing is wrong: the caller's Progress asked to stop
};

// A value or an Error. Call value() only if ok(), error() only if not.
template <class T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::move(value)) {}
    Result(Error error) : state_(std::move(error)) {}

    bool ok() const { return std::holds_alternative<T>(state_); }
    T& value() { return std::get<T>(state_); }
    const T& value() const { return std::get<T>(state_); }
    const Error& error() const { return std::get<Error>(state_); }

  private:
    std::variant<T, Error> state_;
};

// Success or an Error.
template <>
class [[nodiscard]] Result<void> {
  public:
    Result() = default;
    Result(Error error) : error_(std::move(error)) {}

    bool ok() const { return !error_; }
    const Error& error() const { return *error_; }

  private:
    std::optional<Error> error_;
};

struct TextureImage {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgb;  // 3 * width * height, sRGB, row-major, top row first
};

// Colours of a mesh. They belong to the corners of triangles, so that texture seams need no extra vertices. Each array
// but `textures` is empty or has one entry per triangle. A point's colour is its texture colour times its interpolated
// corner colour. A missing factor counts as white.
struct Appearance {
    std::vector<std::array<std::array<float, 3>, 3>> corner_colors;  // sRGB, 0..1
    // u, v: (0, 0) is the top left corner of the texture, (1, 1) the bottom right one. Textures repeat.
    std::vector<std::array<std::array<float, 2>, 3>> corner_texcoords;
    std::vector<uint32_t> triangle_texture;  // index into textures; UINT32_MAX: none
    std::vector<TextureImage> textures;

    bool empty() const { return corner_colors.empty() && (textures.empty() || triangle_texture.empty()); }
};

// The normals with which authors want a mesh shaded. An edge is hard where those of its two triangles differ: tiles keep
// it sharp. Nothing else of them is used. So a mesh whose every vertex has one normal, and a mesh whose every triangle
// has its own (flat shading), tell nothing; then the encoder finds sharp edges by the shape alone, as without normals.
// Vertices at one place count as one: a hard edge may repeat its vertices, as engines want them, or share them.
struct Shading {
    static constexpr uint32_t kFlat = UINT32_MAX;

    std::vector<std::array<float, 3>> normals;  // outwards, of any length; 0 0 0 differs from no other
    // Per triangle, an index into `normals` for each corner; kFlat: that of the triangle. Empty: nothing is known. For
    // one normal per vertex, these are the mesh's triangles.
    std::vector<std::array<uint32_t, 3>> corners;

    bool empty() const { return corners.empty(); }
};

// A triangle soup or mesh as read from a file. Triangles index into `positions`. Coordinates may have any unit.
struct TriangleMesh {
    std::vector<std::array<double, 3>> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
    Appearance appearance = {};
    Shading shading = {};
    // A label 0..255 for each triangle, for example its material; or empty. A file keeps it for each of its cells (gim/decoder.h,
    // "Labels") if there are two different ones. Not of kMcgim.
    std::vector<uint8_t> labels = {};
};

// Called at the start of each stage and during long stages. `fraction` is 0..1 within the stage. Calls never overlap.
// Returns whether to go on. If it returns false, the encoder stops at once and returns an Error with is_cancelled.
using Progress = std::function<bool(Stage stage, double fraction)>;

// ---- comparing ------------------------------------------------------------------------------------------------------

struct CompareOptions {
    uint32_t samples = 0;  // per direction, area-stratified; 0: 4 for each face of both, 100,000 to 500,000
    bool vertices = true;  // the largest distances are also taken at the vertices
    uint64_t seed = 1;     // the same seed gives the same figures
    uint32_t threads = 0;  // 0: all cores; the result does not depend on it
    bool normals = false;  // also measure Comparison::normals; takes about a fifth more time
    bool defects = false;  // also measure Comparison::defects; takes about half more time
};

// Mean angle, in degrees, between the shading normal of a sample and that of the nearest point on the other surface.
// Shading normals are interpolated linearly between vertex normals. A vertex normal is the area-weighted mean normal of
// the triangles around all vertices at its position. A pair counts as 90 degrees if a normal is missing (zero area).
struct NormalError {
    double to_test = 0, to_reference = 0;  // with samples on the reference surface, on the test surface
    double mean = 0;                       // of the two
};

// What a person sees of a surface whose distances are small: folds, scratches, wrong shading. "The other face" is the
// triangle of the other surface that is nearest to a point. Shading normals are here interpolated between
// angle-weighted vertex normals; vertices at equal positions are one.
struct Defects {
    uint64_t folded_faces = 0;  // triangles of the test surface that look away from the other face at their centroid
    double folded_area = 0;     // share of the test surface's area that looks away from the other face; 0..1
    // Shares of the test surface's area whose shading normal is off by more than 20 and 45 degrees; 0..1.
    double off_by_20 = 0, off_by_45 = 0;
    double normals_p95 = 0, normals_p99 = 0;     // degrees; percentiles of that angle over the samples of both surfaces
    double p999_over_rms = 0, max_over_rms = 0;  // 99.9th percentile and maximum of the distance, over Comparison::rms
    // Edges where two triangles meet at more than 150 degrees between their normals.
    uint64_t folded_back_edges = 0, folded_back_edges_of_reference = 0;
    // The largest set of folded faces that hang together by corners. All zero if nothing is folded.
    struct Fold {
        std::array<double, 3> center = {0, 0, 0};  // object units
        double area = 0;                           // object units, squared
        uint64_t faces = 0;
    } largest_fold = {};
};

// Distances are in the unit of the meshes. Cost: O((|A|+|B|+samples) log) with a bounding-volume hierarchy.
struct Comparison {
    double diagonal = 0;                      // bounding-box diagonal of the reference
    double rms_to_test = 0;                   // area-weighted RMS distance, reference -> test surface
    double rms_to_reference = 0;              // test -> reference surface
    double rms = 0;                           // the larger of the two
    double max_to_test = 0;                   // largest sampled distance, reference -> test surface
    double max_to_reference = 0;              // test -> reference surface
    double hausdorff = 0;                     // the larger of the two
    double psnr = 0;                          // 20 log10(diagonal / rms); infinity when rms is 0
    std::optional<NormalError> normals = {};  // set if CompareOptions::normals is
    std::optional<Defects> defects = {};      // set if CompareOptions::defects is
};
Result<Comparison> compare(const TriangleMesh& reference, const TriangleMesh& test, const CompareOptions& options);

// Where the defects of a test surface are, for pictures. Terms as in Defects.
struct DefectMap {
    std::vector<uint8_t> folded;  // per triangle: 1 if it is folded over, else 0
    // Per vertex: angle, in degrees, between its shading normal and that of the nearest point of the reference. 0 if no
    // triangle uses the vertex.
    std::vector<float> off;
    std::vector<std::array<uint32_t, 2>> folded_back;  // edges, by vertex
};
// threads: as in CompareOptions. Cost: O((|A|+|B|) log).
Result<DefectMap> map_defects(const TriangleMesh& reference, const TriangleMesh& test, uint32_t threads = 0);

// The connectivity of a mesh, by its indices. Vertices at equal positions are not merged.
struct TopologySummary {
    uint64_t vertices = 0, edges = 0, triangles = 0;  // referenced vertices only
    uint64_t components = 0;                          // pieces connected through edges
    uint64_t boundary_loops = 0;
    int64_t euler = 0;  // V - E + F
    double genus = 0;   // summed over components; NaN unless the mesh is manifold
    uint64_t boundary_edges = 0;
    uint64_t nonmanifold_edges = 0, nonmanifold_vertices = 0;
    uint64_t misoriented_edges = 0;  // edges whose two faces run along them in the same direction
    bool manifold = false;           // oriented, without non-manifold edges or vertices
    bool watertight = false;         // manifold without boundary
};
TopologySummary summarize_topology(const TriangleMesh& mesh);

// ---- encoding -------------------------------------------------------------------------------------------------------

enum class Layout { kGim, kMcgim, kTiles, kAuto };

// What decides the size of the file.
struct RateTarget {
    enum class Kind {
        kLossless,  // the decoded image equals the quantized image
        kPsnr,      // value: least PSNR of the decoded surface against the input mesh, in dB
        kMaxError,  // value: largest distance between the decoded surface and the input mesh, both ways, above 0
        kBytes,     // value: largest size of the whole file, in bytes
        kQuality,   // value: 0 (smallest file) .. 100 (finest); 10 more halve the quantizer step
    };
    Kind kind = Kind::kQuality;
    double value = 75;
    bool in_diagonals = false;  // kMaxError: `value` counts bounding-box diagonals of the input, not object units
};

struct Length {
    double value = 0;
    bool in_diagonals = false;  // `value` counts bounding-box diagonals of the input, not object units
};

// How far samples may move to bring the image's surface nearer to the input.
enum class FitStrength {
    // Loose for lossless files, else stiff. Lossy squares are then also fitted to their quantizer, which saves a fifth
    // of the bytes or more at the same error.
    kAuto,
    kOff,    // samples stay where they are taken
    kStiff,  // samples hardly slide along the surface, so files hardly grow; about +4 dB
    kLoose,  // samples slide to the surface's creases; about +9 dB, and much more tangential detail
};

struct EncodeOptions {
    Layout layout = Layout::kGim;
    // kGim: samples per side of the square, 2^j + 1. Twice the side takes four times the time and memory. Several
    // components share side * side samples by area; each gets at least 9 x 9, and more where its cut needs room.
    // More than side * side for one component becomes a warning.
    uint32_t side = 257;
    // kGim with a coarse target of PSNR, distance or bytes: also codes images of half the side, halves again while that
    // gives a better file, and keeps the best file. Takes about 1.5 times the time. The cut is chosen at the first half.
    // kMcgim with such a target: the same with half the samples. Takes 2 to 3 times the time.
    bool try_smaller_sides = false;
    // kMcgim, kTiles: largest width * height. Charts that do not fit get up to 32 times as many, with a warning.
    uint32_t samples = 66049;
    // kMcgim: wanted number of charts; 0: chosen by the shape. More are made if topology or flattening needs them.
    uint32_t charts = 0;
    // kTiles: wanted number of tiles; 0: chosen by the encoder. More are made if topology needs them.
    uint32_t tiles = 0;
    // kTiles: sharp edges of the surface become borders of tiles, unless the target is searched for and the file is smaller
    // without. They are the hard edges of TriangleMesh::shading if that tells any, else those that the shape shows.
    bool creases = true;
    // kGim: side of the grid on which cut-nodes lie; more than `side` counts as `side`. All levels down to this side are
    // closed. The encoder takes a finer grid if the cut does not fit whole units of this one.
    uint32_t node_side = 17;
    uint32_t bits = 12;  // quantizer: bits per coordinate of the bounding box, 8..20
    RateTarget rate;
    FitStrength fit = FitStrength::kAuto;
    // A surface that is no oriented manifold. false: it is repaired. true: encode() fails and says where it is broken.
    bool strict = false;
    // Boundary vertices that are not farther apart are welded. Unset: a millionth of the bounding box's diagonal, 0 if
    // strict. 0: only vertices at equal positions are. At most a tenth of the diagonal.
    std::optional<Length> weld_tolerance = {};
    bool density = true;  // true: more samples where a first sampling leaves more error; false: even spacing

    // Attribute planes. Sides: 2^j + 1, at most 4097, independent of `side`. Twice the side takes four times the bytes.
    uint32_t normal_side = 0;  // normals of the input; 0: none
    // Colours of the input; 0: none. Unset: about as fine as the input's colours, at most 1025. No plane is made if the
    // input has no colours.
    std::optional<uint32_t> color_side;
    // 0..100; 10 more halve the step. Unset: the quality of `rate` if it has one; else 90 for lossless images, 75 for
    // lossy ones. Planes are always lossy.
    std::optional<double> plane_quality;

    uint32_t effort = 5;  // 1 (fastest) .. 9 (smallest file); of lossy files. README.md has a table
    uint64_t seed = 1;
    uint32_t threads = 0;  // 0: all cores; the bytes do not depend on it
};

// One level of the file: all images, each at this level or at its coarsest closed level if that is finer.
struct LevelReport {
    uint32_t level = 0;                    // 0: full resolution
    uint32_t width = 0, height = 0;        // of the largest image
    uint64_t vertices = 0, triangles = 0;  // of the decoded surface
    uint64_t prefix_bytes = 0;             // bytes from the start of the file that this level needs
    double psnr = 0;                       // dB, decoded surface against the input mesh
    double rms_error = 0, max_error = 0;   // object units, likewise; the larger of both ways
    Defects defects = {};                  // likewise; coarser levels are measured with fewer samples
};

// What cleaning did to make the surface codable (spec/bad-meshes.md). Apart from the first three, the counts do not depend
// on how a file shares or repeats vertices.
struct Repairs {
    uint64_t welded_vertices = 0;        // became part of another at the same place
    uint64_t unreferenced_vertices = 0;  // dropped
    uint64_t degenerate_triangles = 0;   // dropped: two corners at one place
    uint64_t nearly_welded = 0;          // boundary points that became part of another within the weld tolerance
    uint64_t duplicate_triangles = 0;    // dropped: they repeat another
    uint64_t double_triangles = 0;       // dropped: they lie on the back of another, without solid between
    uint64_t slivers = 0;                // triangles without area whose points went into the neighbours' edges
    uint64_t crowded_edges = 0;          // edges of more than two faces, which were joined in pairs
    uint64_t cut_edges = 0;              // those of them that keep an open face
    uint64_t split_points = 0;           // points in which the surface touches itself
    uint64_t one_sided_cuts = 0;         // edges along which a one-sided surface was cut open
    uint64_t flipped_triangles = 0;      // turned over, to agree with their neighbours
    uint64_t inside_out = 0;             // closed components that show their inner side: cavities, rooms
};

struct StageTime {
    std::string stage;
    double seconds = 0;
};

// Figures of one attribute plane.
struct PlaneReport {
    enum class Kind { kNormals, kColors };
    Kind kind = Kind::kNormals;
    uint32_t width = 0, height = 0;  // of the largest image
    uint64_t bytes = 0;              // of the plane's chunk
    // The decoded plane on the decoded surface is compared with the input, over the input's surface.
    double mean_angle = 0;  // kNormals: degrees
    double psnr = 0;        // kColors: dB, of sRGB values
};

// What another layout would cost for the same target. kMaxError: both figures are those of files with about that error.
struct LayoutCost {
    Layout layout = Layout::kGim;
    double bytes = 0, psnr = 0;  // of the whole file; of the decoded surface, in dB
    bool is_estimate = false;    // true: from a brief fit, which takes 5 to 10 % more bytes than a full one
};

// Figures of one run, in the order they become known.
struct EncodeReport {
    uint64_t input_vertices = 0, input_triangles = 0;  // as read
    Repairs repairs;                                   // by cleaning
    std::vector<std::string> warnings;                 // for people, a line each
    TopologySummary topology;                          // of the cleaned mesh
    uint64_t hard_edges = 0;                           // of the cleaned mesh, by TriangleMesh::shading
    uint64_t hard_edges_kept = 0;                      // kTiles: those of them that tiles keep sharp
    Layout layout = Layout::kGim;                      // the one used; never kAuto
    std::vector<LayoutCost> others;                    // kAuto, lossy: the layouts that lost
    uint32_t images = 0;                               // kGim: one per component; else 1
    uint32_t width = 0, height = 0;                    // of the largest image
    uint64_t samples = 0;                              // of all images
    uint32_t side = 0, node_side = 0;                  // kGim: of the largest image; kTiles: of a tile
    uint32_t cut_paths = 0;                            // of all images
    uint32_t charts = 0;                               // kMcgim
    uint32_t tiles = 0;                                // kTiles
    uint64_t defined_samples = 0;                      // kMcgim
    uint64_t border_samples = 0, open_samples = 0;     // of an imported image; open: one surface point with no other
    double packing_efficiency = 0;                     // kMcgim: defined_samples / samples
    double cut_length = 0;                             // object units
    double stretch_efficiency = 0;                     // 1 / (normalised L2 stretch)^2; 0..1, 1: uniform and isotropic
    uint64_t folds = 0;              // triangles of decoded level 0 that look away from the input: error's folded_faces
    uint64_t folds_before_fit = 0;   // faces of the sampled image that do, before it is fitted; 0 without fit
    uint64_t flipped_triangles = 0;  // in the parametrization; always 0 if encoding succeeds
    double bits_per_sample = 0, bits_per_vertex = 0;  // bits of the file per sample, per input vertex
    uint64_t file_bytes = 0, sideband_bytes = 0;
    std::vector<PlaneReport> planes;
    Comparison error;                 // decoded level 0 against the input mesh
    std::vector<LevelReport> levels;  // finest first
    std::vector<StageTime> times;
    double seconds = 0;
};

struct Encoded {
    std::vector<uint8_t> bytes;  // a complete .gim file
    EncodeReport report;
};

// An intermediate state, for pictures: a mesh opened along its cut, with a parametrization.
struct Snapshot {
    std::string name;                          // for file names: lower case, digits and hyphens
    std::string caption;                       // for people: what was done, and its figures
    TriangleMesh mesh;                         // has one copy of a cut vertex for each side of the cut
    std::vector<std::array<uint32_t, 2>> cut;  // edges of `mesh` along the cut and the input's boundaries
    std::vector<std::array<double, 2>> uv;     // per vertex; unit disk during the cut search, unit square afterwards
};
// encode() calls this with each state. Making the states takes about a tenth of the run. Calls never overlap.
using Observer = std::function<void(const Snapshot& state)>;

// Encodes a mesh. Cleaning must be able to make it an orientable 2-manifold. kGim: each component becomes one image.
Result<Encoded> encode(const TriangleMesh& mesh, const EncodeOptions& options, const Progress& progress = {},
                       const Observer& observer = {});

// Encodes an existing geometry image: side*side*3 floats, all x, then all y, then all z; sample (i, j) at j*side + i.
// Boundary samples within `weld_tolerance` (object units) of each other are glued if that gives a closed surface.
Result<Encoded> encode_image(const std::vector<float>& channels, uint32_t side, double weld_tolerance,
                             const EncodeOptions& options, const Progress& progress = {});

// The type of the numbers of an image of another program, in the order of GIM_SAMPLE_... (gim/decoder.h).
enum class SampleType { kFloat32, kFloat64, kFloat16, kUint8, kInt8, kUint16, kInt16, kUint32, kInt32 };
constexpr bool is_whole(SampleType type) { return type >= SampleType::kUint8; }

// A multi-chart image of another program. Doubles hold the numbers of all types exactly.
struct RasterImage {
    // Where the array had its mask. kNowhere: undefined samples are NaN, or there are none.
    enum class Mask : uint32_t { kNowhere, kArray, kChannel };

    uint32_t width = 0, height = 0;
    uint32_t channels = 3;         // x, y, z, then others. The mask is none of them
    std::vector<double> values;    // width * height * channels, sample by sample, row by row
    std::vector<uint8_t> defined;  // per sample; not 0: it is defined
    SampleType type = SampleType::kFloat32;
    // How the array looked. The file keeps it, so that a decoder can make the same array again.
    bool is_channels_first = false;
    Mask mask = Mask::kNowhere;
    uint32_t mask_channel = 3;            // kChannel: its place among the channels of the array
    uint32_t mask_value = 1;              // what the mask says of defined samples; it says 0 of others
    std::vector<std::string> names = {};  // of the channels; empty: nobody named them
};

// Encodes such an image as it is: no sample moves to another place. Whole numbers of up to 20 bits are exact with
// RateTarget::kLossless; floats are rounded to options.bits of the bounding box, those of each channel from the fourth on
// to as many bits of its range. Other targets make the positions coarser, never the other channels; the reference is the
// image's own surface. Border samples that are not farther apart than options.weld_tolerance are one point of the surface;
// unset: a millionth of the diagonal for floats, 0 for whole numbers. Layout, size, charts and fit are not read.
Result<Encoded> encode_raster(const RasterImage& image, const EncodeOptions& options, const Progress& progress = {});

}  // namespace gim
