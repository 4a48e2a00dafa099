#include <inttypes.h>
#include <stdio.h>
#include <weft/weft_c.h>

/* A sheet of 9 x 9 vertices in the plane y = 0, 1 m apart. */
enum { kSide = 9, kVertices = kSide * kSide, kFaces = (kSide - 1) * (kSide - 1) };
static double positions[3 * kVertices];
static uint32_t corners[4 * kFaces], face_sizes[kFaces];

static void lay_out_sheet(void) {
  for (uint32_t row = 0; row < kSide; ++row) {
    for (uint32_t column = 0; column < kSide; ++column) {
      double* place = positions + 3 * (row * kSide + column);
      place[0] = column, place[1] = 0, place[2] = row;
      if (row == 0 || column == 0) continue;
      const uint32_t face = (row - 1) * (kSide - 1) + column - 1, last = row * kSide + column;
      const uint32_t its[4] = {last - kSide - 1, last - kSide, last, last - 1};
      for (int i = 0; i < 4; ++i) corners[4 * face + i] = its[i];
      face_sizes[face] = 4;
    }
  }
}

static int fail(void) { return puts(weft_last_message()), 1; }

int main(void) {
  lay_out_sheet();
  const uint32_t pins[2] = {0, kSide - 1};
  weft_mesh mesh;
  weft_init_mesh(&mesh, sizeof mesh);
  mesh.vertex_count = kVertices, mesh.positions = positions;
  mesh.corner_count = 4 * kFaces, mesh.corners = corners;
  mesh.face_count = kFaces, mesh.face_sizes = face_sizes;
  mesh.pin_count = 2, mesh.pins = pins;
  weft_mesh_cloth* made = NULL;
  if (weft_cloth_from_mesh(&mesh, &made)) return fail();
  weft_scene scene;
  weft_init_scene(&scene, sizeof scene);
  weft_model* model = NULL;
  weft_cloth* cloth = NULL;
  if (weft_scene_of(made, &scene) || weft_build_model(&scene, &model)) return fail();
  if (weft_create_cloth(model, NULL, &cloth)) return fail();

  const double up[3] = {0, 1, 0};
  weft_shape* floor = NULL;
  weft_body body;
  uint32_t id;
  if (weft_plane(up, -1, &floor) || weft_init_body(&body, sizeof body)) return fail();
  body.shape = floor;
  if (weft_add_body(cloth, &body, &id)) return fail();

  for (int frame = 0; frame < 60; ++frame) {
    if (weft_step(cloth, 0.01, NULL, NULL)) return fail();
  }
  printf("%016" PRIx64 "\n", weft_state_hash(cloth));
  weft_free_shape(floor), weft_free_cloth(cloth), weft_free_model(model),
      weft_free_mesh_cloth(made);
  return 0;
}
