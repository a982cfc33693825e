/* Decodes every image of a file at full resolution, as the head of gim/decoder.h shows. Exit 0: all triangles decoded. */
#include <gim/decoder.h>
#include <stdio.h>
#include <stdlib.h>

static unsigned char* read_all(const char* name, size_t* size) {
    unsigned char* bytes = NULL;
    long length = 0;
    FILE* file = fopen(name, "rb");
    if (!file) return NULL;
    if (fseek(file, 0, SEEK_END) == 0 && (length = ftell(file)) > 0 && fseek(file, 0, SEEK_SET) == 0) {
        bytes = malloc((size_t)length);
        if (bytes && fread(bytes, 1, (size_t)length, file) != (size_t)length) {
            free(bytes);
            bytes = NULL;
        }
    }
    *size = (size_t)length;
    fclose(file);
    return bytes;
}

static gim_status decode_image(const gim_info* info, const void* bytes, size_t size, uint32_t image) {
    gim_level_info level;
    gim_status status = gim_read_level_info(info, bytes, size, image, 0, &level);
    if (status == GIM_OK) {
        float* positions = malloc((size_t)level.vertex_count * 3 * sizeof(float));
        uint32_t* triangles = malloc((size_t)level.triangle_count * 3 * sizeof(uint32_t));
        void* scratch = malloc((size_t)level.scratch_size);
        if (positions && triangles && scratch)
            status = gim_decode_mesh(info, bytes, size, image, 0, positions, NULL, NULL, triangles, scratch,
                                     (size_t)level.scratch_size);
        else
            status = GIM_LIMIT_EXCEEDED;
        printf("image %u: %u vertices, %u triangles: %s\n", (unsigned)image, (unsigned)level.vertex_count,
               (unsigned)level.triangle_count, gim_status_text(status));
        free(positions);
        free(triangles);
        free(scratch);
    }
    return status;
}

int main(int argc, char** argv) {
    size_t size = 0;
    unsigned char* bytes = argc == 2 ? read_all(argv[1], &size) : NULL;
    gim_info info;
    gim_status status = GIM_BAD_ARGUMENT;
    uint32_t image;
    if (!bytes) return 2;
    status = gim_read_info(bytes, size, NULL, &info);
    for (image = 0; status == GIM_OK && image < info.image_count; ++image)
        status = decode_image(&info, bytes, size, image);
    free(bytes);
    return status == GIM_OK ? 0 : 1;
}
