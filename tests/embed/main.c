#include <stdio.h>
#include <weft/weft_c.h>

int main(void) {
  const double positions[6] = {0, 0, 0, 1, 0, 0}, masses[2] = {1, 1}, length = 1;
  const uint32_t ends[2] = {0, 1}, fixed = 0;
  weft_scene scene; /* a pendulum */
  weft_init_scene(&scene, sizeof scene);
  scene.particle_count = 2, scene.positions = positions, scene.masses = masses;
  scene.constraint_count = 1, scene.constraint_particles = ends, scene.rest_lengths = &length;
  scene.fixed_count = 1, scene.fixed = &fixed;
  weft_model* model = NULL;
  weft_cloth* cloth = NULL;
  int failed = weft_build_model(&scene, &model) || weft_create_cloth(model, NULL, &cloth);
  for (int i = 0; i < 50 && !failed; ++i) failed = weft_step(cloth, 0.01, NULL, NULL) != WEFT_OK;
  double place[3];
  failed = failed || weft_position(cloth, 1, place);
  if (failed)
    puts(weft_last_message());
  else
    printf("after 0.5 s it is at %g, %g m\n", place[0], place[1]);
  weft_free_cloth(cloth), weft_free_model(model);
  return failed;
}
