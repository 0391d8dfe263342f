package skein.planning;

import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;
import static skein.simd.LaneMath.constant;

import jdk.incubator.vector.FloatVector;
import skein.vehicle.ReducedModel;

/**
 * Steps of a {@link ReducedModel} with one lag that are short beside it. The formulas stand there; (1 −
 * e^(−a)) / a, a being the rate at which velocity dies away times the step, is the series 1 − a/2 +
 * a²/6 − …, whose next term is below 7e-6 for a up to 0.5.
 *
 * <p>{@link ReducedModel#step} compiled as any other {@code Plant} does the same; such steps are a
 * quarter of a search's time, so they are written out and save the exponential.
 */
final class ShortLagStep {
  private static final int SIZE = CandidateBlock.Size();

  private final float[] x, y, vx, vy;
  private final float dtS, perLag, drag, brake, gain;

  /**
   * @param x positions, m, and velocities, m/s, north and east, row by row
   */
  ShortLagStep(ReducedModel model, double dtS, float[] x, float[] y, float[] vx, float[] vy) {
    this.x = x;
    this.y = y;
    this.vx = vx;
    this.vy = vy;
    this.dtS = (float) dtS;
    perLag = (float) (dtS / model.lagS());
    drag = (float) (model.dragPerM() * dtS);
    brake = (float) (model.dragPerM() * model.lagS());
    gain = (float) model.gain();
  }

  static boolean fits(ReducedModel model, double dtS) {
    return model.turnLagS() == model.lagS() && model.lagS() >= 2.5 * dtS;
  }

  /**
   * Flies all candidates from a row to the next.
   *
   * @param north of the commanded velocity, over {@code speed}
   */
  void fly(int row, float[] north, float[] east, float speed) {
    int at = row * SIZE;
    FloatVector dt = constant(dtS),
        perLag = constant(this.perLag),
        drag = constant(this.drag),
        brake = constant(this.brake),
        gain = constant(this.gain * speed),
        one = constant(1f),
        second = constant(-1f / 2),
        third = constant(1f / 6),
        fourth = constant(-1f / 24),
        fifth = constant(1f / 120),
        sixth = constant(-1f / 720);
    for (int i = 0, from = at, to = at + SIZE; i < SIZE; i += LANES, from += LANES, to += LANES) {
      FloatVector ownX = FloatVector.fromArray(SPECIES, vx, from),
          ownY = FloatVector.fromArray(SPECIES, vy, from);
      FloatVector pace = ownX.fma(ownX, ownY.mul(ownY)).sqrt();
      FloatVector a = pace.fma(drag, perLag);
      FloatVector slide = a.fma(sixth, fifth).fma(a, fourth).fma(a, third).fma(a, second);
      FloatVector glided = slide.fma(a, one);
      FloatVector decay = one.sub(glided.mul(a)), glide = glided.mul(dt);
      FloatVector reached = gain.div(pace.fma(brake, one));
      FloatVector wantedX = FloatVector.fromArray(SPECIES, north, i).mul(reached),
          wantedY = FloatVector.fromArray(SPECIES, east, i).mul(reached);
      FloatVector offX = ownX.sub(wantedX), offY = ownY.sub(wantedY);
      offX.fma(glide, wantedX.fma(dt, FloatVector.fromArray(SPECIES, x, from))).intoArray(x, to);
      offY.fma(glide, wantedY.fma(dt, FloatVector.fromArray(SPECIES, y, from))).intoArray(y, to);
      offX.fma(decay, wantedX).intoArray(vx, to);
      offY.fma(decay, wantedY).intoArray(vy, to);
    }
  }
}
