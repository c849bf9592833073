/* There are no more suspects and segments than points: for WP. The rest is Eva's (extract_segment.c).
 *
 * proves: lib/extract/segment.c
 * with: lib/base/fixed.c
 * wp: slope_um look_at add_suspects ale_segment_suspect end_segment ale_segment_cut
 * options: -wp-prop=@requires,@assert,@ensures,@invariant,@assigns */
