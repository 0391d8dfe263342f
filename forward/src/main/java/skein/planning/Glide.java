package skein.planning;

/**
 * How far a velocity that dies away at a rate carries a vehicle in a step: (1 − e^(−a)) / a of the way
 * that it would carry it undiminished, a being the rate times the step. The series is 1 − a/2 + a²/6 −
 * …, whose next term is below 7e-6 for a up to 0.5.
 */
final class Glide {
  static final float GLIDE_1 = -1f / 2, GLIDE_2 = 1f / 6, GLIDE_3 = -1f / 24;
  static final float GLIDE_4 = 1f / 120, GLIDE_5 = -1f / 720;

  private Glide() {}
}
