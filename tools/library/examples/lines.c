/* Lines and corners of one scan. Standard input: bearing of the first beam and step from beam to beam in
 * degrees, then the ranges in metres (0: nothing seen).
 *
 *     cc lines.c $(pkg-config --cflags --libs libale) -lm -o lines && ./lines < room.txt */
#include <ale/ale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

int main(void)
{
    static ale_scan_t scan = {.range_min_um = 20000, .range_max_um = 30000000};
    static ale_features_t found;
    double first, step, range;
    if (scanf("%lf %lf", &first, &step) != 2) {
        fputs("lines: first bearing and step are missing\n", stderr);
        return 2;
    }
    scan.first_bearing_bam = (uint32_t)llround(first * ALE_BAM_PER_DEGREE);
    scan.step_bam = (int32_t)lround(step * ALE_BAM_PER_DEGREE);
    while (scan.beams < ALE_MAX_BEAMS && scanf("%lf", &range) == 1)
        ale_scan_set_range(&scan, scan.beams++, (int32_t)lround(range * 1e6));
    if (scan.beams == ALE_MAX_BEAMS && scanf("%lf", &range) == 1) {
        fprintf(stderr, "lines: more than %d beams\n", ALE_MAX_BEAMS);
        return 1;
    }

    const ale_extract_config_t config = ale_extract_default_config();
    ale_extractor_t *extractor = malloc(ale_extractor_size());
    if (extractor == NULL || ale_extractor_init(extractor, &config) < 0)
        return 1;
    ale_extract_scan(extractor, &scan, NULL, &found);
    for (int k = 0; k < found.line_count; k++)
        printf("line beams %d to %d, %.3f m away, rmse %.1f mm\n", found.line[k].first, found.line[k].last,
               found.line[k].rho_um * 1e-6, found.line[k].rmse_um * 1e-3);
    for (int k = 0; k < found.corner_count; k++)
        printf("corner at %.3f %.3f\n", found.corner[k].p.x_um * 1e-6, found.corner[k].p.y_um * 1e-6);
    free(extractor);
    return 0;
}
