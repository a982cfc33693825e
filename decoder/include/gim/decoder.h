/* gim/decoder.h: reads .gim files (spec/gim-format.md). C99 and C++.
 *
 * Nothing here allocates, prints, throws or keeps state: sizes come from functions, memory from the caller; up to 32
 * KiB of stack are used. Every byte of the input is treated as hostile. Any number of threads may decode the same bytes
 * at the same time.
 *
 *   gim_info info;
 *   gim_status s = gim_read_info(bytes, size, NULL, &info);              // header and index only
 *   gim_level_info level;
 *   s = gim_read_level_info(&info, bytes, size, 0, 0, &level);           // image 0, level 0 = full resolution
 *   float*    positions = malloc(level.vertex_count * 3 * sizeof(float));
 *   uint32_t* triangles = malloc(level.triangle_count * 3 * sizeof(uint32_t));
 *   void*     scratch   = malloc(level.scratch_size);
 *   s = gim_decode_mesh(&info, bytes, size, 0, 0, positions, NULL, NULL, triangles, scratch, level.scratch_size);
 *
 * A file holds one or more images (one per connected component of the surface). Each image is a square of
 * side x side surface points, side = 2^j + 1; level L has side 2^(j-L) + 1. Images of one file may differ in side: the
 * coarser levels of the file leave the small ones out. Seen from outside, the boundary of the square runs
 * counter-clockwise along row 0 with rising column first: (d position / d column) x (d position / d row) points
 * outwards. */
#ifndef GIM_DECODER_H
#define GIM_DECODER_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifndef GIM_API
#define GIM_API
#endif

/* Negative: feed more bytes and call again. Zero: done. Positive: final. The numbers are never reused. */
typedef int32_t gim_status;
enum {
    GIM_NEED_MORE_INPUT = -1,
    GIM_OK = 0,
    GIM_NOT_GIM = 1,
    GIM_UNSUPPORTED_VERSION = 2,
    GIM_MALFORMED = 3,
    GIM_LIMIT_EXCEEDED = 4,
    GIM_BAD_ARGUMENT = 5,
    GIM_SCRATCH_TOO_SMALL = 6,
    GIM_CHECKSUM = 7,
    GIM_NO_SUCH_LEVEL = 8,
    GIM_NO_SUCH_PLANE = 9
};
/* A short English description of any status; never NULL. */
GIM_API const char* gim_status_text(gim_status status);

enum { GIM_LAYOUT_GIM = 0, GIM_LAYOUT_MCGIM = 1, GIM_LAYOUT_TILES = 2 };
enum { GIM_CODING_LOSSLESS = 0, GIM_CODING_LOSSY = 1 };
enum { GIM_MAX_LEVELS = 14 };

/* What the caller is willing to take. NULL where a gim_limits* is asked for means these defaults. */
typedef struct gim_limits {
    uint64_t max_samples; /* samples of all images together; default 2^26 */
    uint32_t max_images;  /* default 65536 */
    uint32_t max_side;    /* default 16385 */
} gim_limits;

/* Header and index of a file. Plain values; keeps no pointer into the bytes. */
typedef struct gim_info {
    uint32_t version;
    uint32_t layout; /* GIM_LAYOUT_... */
    uint32_t coding; /* GIM_CODING_... */
    uint32_t bits;   /* quantizer: bits per coordinate of the bounding box, 8..20 */
    uint32_t image_count;
    uint32_t level_count;  /* levels stored; image i can close levels 0 .. gim_level_info.coarsest_level */
    uint32_t chunk_count;  /* for gim_read_chunk */
    uint64_t sample_count; /* all images at level 0 */
    uint64_t file_size;    /* of the whole file, as the index tells */
    float origin[3];       /* position = origin + step * integer (lossless) */
    float step;            /* object units per quantization step, > 0 */
    float quantizer;       /* lossy: step across the surface, unit norm, mean density, in quantization steps; else 0 */
    uint32_t index_size;   /* bytes of header and index; a prefix of this length suffices for gim_read_info */
    float level_psnr[GIM_MAX_LEVELS]; /* dB, as the encoder measured each level against its input, rounded down to half
                                         decibels; level 0 first; 0: not told */
    gim_limits limits;                /* in force for later calls */
} gim_info;

/* Reads header and index, verifies their checksum. Cost O(index). */
GIM_API gim_status gim_read_info(const void* bytes, size_t size, const gim_limits* limits, gim_info* info);

/* One level of one image. */
typedef struct gim_level_info {
    uint32_t side;           /* GIM_LAYOUT_GIM: samples per side; else 0 */
    uint32_t width, height;  /* of the grid of samples; width == height == side where there is one */
    uint32_t coarsest_level; /* the coarsest level of this image that its seams can close */
    uint32_t vertex_count;   /* of the fused mesh: mates share one vertex */
    uint32_t triangle_count;
    uint64_t prefix_size;  /* bytes of the file, from its start, that this level needs */
    uint64_t scratch_size; /* bytes of scratch for the decode calls on this level */
} gim_level_info;

/* level: 0 = full resolution. Reads the image's sideband, so `size` must reach it (a few hundred bytes).
 * GIM_NO_SUCH_LEVEL beyond coarsest_level. Cost O(side). */
GIM_API gim_status gim_read_level_info(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                       uint32_t level, gim_level_info* level_info);

/* Decodes one level of one image: width*height*3 floats, row-major, object units, seams closed (samples that are one surface
 * point are bit-equal and the correction is diffused into the interior); NaN where GIM_LAYOUT_MCGIM leaves samples
 * undefined. Of that layout the grid of level 0 is the rectangle that the charts are packed into; coarser ones lie beside
 * each other in a grid of their own. Reads only the first prefix_size bytes. scratch: scratch_size bytes, 16-byte aligned;
 * contents undefined afterwards. On failure positions are unspecified. Cost O(samples). The floats are the same bits on
 * every platform. */
GIM_API gim_status gim_decode_positions(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                        uint32_t level, float* positions, void* scratch, size_t scratch_size);

/* The same level as an indexed triangle mesh, watertight across the seams.
 * positions  vertex_count*3 floats, object units. GIM_LAYOUT_GIM: the vertices of the boundary ring come first, then the
 *            inner samples row by row; GIM_LAYOUT_MCGIM: in the order of their first samples, chart after chart
 * normals    vertex_count*3 floats, unit length, zero where undefined; or NULL
 * texcoords  vertex_count*2 floats: u = column / (width-1), v = row / (height-1) of the implicit parametrization, those of
 *            level 0 at every level; a vertex on a seam has that of its first sample; or NULL
 * triangles  triangle_count*3 indices, counter-clockwise seen from outside; quads are split along the shorter diagonal,
 *            except where that would make two edges one (spec, "Surface", "Charts"); or NULL */
GIM_API gim_status gim_decode_mesh(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                                   float* positions, float* normals, float* texcoords, uint32_t* triangles,
                                   void* scratch, size_t scratch_size);

/* The same level as a grid mesh for texturing: width*height vertices in row-major order, samples on seams repeated with
 * equal positions and normals; undefined ones are in no triangle, their normals and texcoords 0. The rest as in gim_decode_mesh, triangles indexing
 * samples. normals, texcoords and triangles may be NULL. */
GIM_API gim_status gim_decode_grid(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                                   float* positions, float* normals, float* texcoords, uint32_t* triangles,
                                   void* scratch, size_t scratch_size);

/* Attribute planes: what a surface has besides its shape, as images on the same square or rectangle at a resolution of their
 * own. Sample (row, column) of a plane belongs to the surface point at row/(height-1), column/(width-1) of the image.
 * GIM_LAYOUT_GIM: samples of one surface point on the cut are bit-equal. GIM_LAYOUT_MCGIM: samples between the charts have
 * values that go on smoothly, for filtering. A file may have one plane of each kind, of all its images.
 *   GIM_PLANE_NORMALS  the input's unit normals in object space, pointing out of the surface; 0 0 0 where undefined
 *   GIM_PLANE_COLORS   red, green, blue in 0..1, encoded as sRGB */
enum { GIM_PLANE_NORMALS = 0, GIM_PLANE_COLORS = 1 };
typedef struct gim_plane_info {
    uint32_t width, height;  /* samples at this level; independent of the image's at level 0 */
    uint32_t coarsest_level; /* of the plane: level L has every 2^L-th sample's place */
    float quantizer;       /* quantizer step: colours in 1/255, normals in 1/1024 of a unit vector as gim writes them */
    uint64_t stream_size;  /* bytes of this image's plane in the file */
    uint64_t prefix_size;  /* bytes of the file, from its start, that the plane needs */
    uint64_t scratch_size; /* bytes of scratch for gim_decode_plane on this level */
} gim_plane_info;

/* level: of the plane, 0 = full resolution. GIM_NO_SUCH_PLANE where the file has none of that kind (told by the index alone),
 * GIM_NEED_MORE_INPUT unless prefix_size bytes are there. Cost O(chunk). */
GIM_API gim_status gim_read_plane_info(const gim_info* info, const void* bytes, size_t size, uint32_t image,
                                       uint32_t kind, uint32_t level, gim_plane_info* plane_info);

/* values: width*height*3 floats, row-major. scratch: as for positions. On failure values are unspecified. Cost O(side^2). The
 * floats are the same bits on every platform. */
GIM_API gim_status gim_decode_plane(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t kind,
                                    uint32_t level, float* values, void* scratch, size_t scratch_size);

/* Chunk i of the index, for tools that describe a file. GIM_BAD_ARGUMENT past the last chunk. */
typedef struct gim_chunk {
    char name[8];  /* zero-terminated, as in the spec; "????": unknown to this reader */
    uint32_t type; /* number in the file */
    int32_t level; /* -1: not a level */
    uint64_t offset, size;
    uint64_t raw_size; /* after decompression; equal to size where nothing is compressed */
    uint32_t intact;   /* 1: bytes present and checksum correct; 0: not */
} gim_chunk;
GIM_API gim_status gim_read_chunk(const gim_info* info, const void* bytes, size_t size, uint32_t i, gim_chunk* chunk);

/* The text that the file carries about itself (META chunk): UTF-8, not zero-terminated. text_size receives its length, 0 where
 * there is none. text NULL: only the length is wanted. capacity: bytes of text; less than the length is
 * GIM_SCRATCH_TOO_SMALL. The length is a claim of the file: cap it before you allocate.
 * scratch: gim_text_scratch_size() bytes, 16-byte aligned; may be NULL as long as text is. */
GIM_API size_t gim_text_scratch_size(void);
GIM_API gim_status gim_read_text(const gim_info* info, const void* bytes, size_t size, char* text, size_t capacity,
                                 uint64_t* text_size, void* scratch, size_t scratch_size);

/* The gluing of an image's ring at a level, for tools: class_of has 4*(side-1) entries, equal numbers for samples that
 * are one surface point (ring order: along row 0, down the last column, back along the last row, up column 0). NULL:
 * not wanted; it must be NULL where the layout is not GIM_LAYOUT_GIM. */
GIM_API gim_status gim_read_seams(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                                  uint32_t* class_of, uint32_t* path_count);

#ifdef __cplusplus
}
#endif

#endif
