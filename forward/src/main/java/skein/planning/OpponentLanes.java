package skein.planning;

import static skein.planning.BlockWay.SIZE;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import skein.lanes.PolicyLanes;
import skein.simd.LaneFunction;
import skein.vehicle.ReducedModel;

/**
 * A {@link Target.Opponent} against each of a block's candidates: it decides at every step by its
 * policy, compiled from the policy itself. {@link ManoeuvreRollout} is the scalar reference. Mutable.
 */
final class OpponentLanes {
  // Places of what a policy sees; see PolicyLanes.In.
  private static final int ELAPSED = 4, OWN_COS = 5, OWN_SIN = 6, KNOWN_COS = 7, KNOWN_SIN = 8;
  private static final int HEADING = 9, MEMORY = 12;

  private Target.Opponent opponent;
  private PolicyLanes form;
  private LaneFunction function;
  private float[] parameters, scratch;

  /** What the policy sees and remembers, by input; and what it decides, by output. */
  private float[][] seen, decided;

  private float[][] arrays;
  private int[] offsets;

  /** Takes whom to fly from now on; the policy must be a formula. */
  void take(Target.Opponent opponent) {
    if (opponent == this.opponent) return;
    this.opponent = opponent;
    PolicyLanes form = PolicyLanes.get(opponent.policy());
    if (form != this.form) use(form);
    double[] numbers = form.parametersOf(opponent.policy());
    for (int i = 0; i < numbers.length; i++)
      for (int world = 0; world < SIZE; world++)
        parameters[LaneFunction.place(i, world, numbers.length)] = (float) numbers[i];
  }

  private void use(PolicyLanes form) {
    this.form = form;
    function = form.functionOfDifferences();
    parameters = new float[form.parameters() * SIZE];
    scratch = new float[function.scratch()];
    seen = new float[form.inputs()][SIZE];
    decided = new float[form.memories() + 3][SIZE];
    arrays = new float[seen.length + decided.length][];
    offsets = new int[arrays.length];
  }

  /**
   * Flies through all steps.
   *
   * @param own the candidates' way
   * @param cos of the headings commanded to them before each step, and {@code sin}
   * @param origin where positions are counted from
   */
  void fly(BlockWay own, float[] cos, float[] sin, Motion origin, float dtS, BlockWay into) {
    into.start(opponent.motion(), origin);
    Arrays.fill(seen[ELAPSED], dtS);
    Arrays.fill(seen[OWN_COS], (float) StrictMath.cos(opponent.headingRad()));
    Arrays.fill(seen[OWN_SIN], (float) StrictMath.sin(opponent.headingRad()));
    Arrays.fill(
        seen[HEADING], (float) StrictMath.IEEEremainder(opponent.headingRad(), 2 * Math.PI));
    double[] remembered = form.initialOf(opponent.policy());
    for (int i = 0; i < remembered.length; i++) Arrays.fill(seen[MEMORY + i], (float) remembered[i]);
    for (int at = 0; at < cos.length; at += SIZE) {
      look(own.x, into.x, seen[0], own.y, into.y, seen[1], at);
      if (form.needsVelocity()) look(own.vx, into.vx, seen[2], own.vy, into.vy, seen[3], at);
      decide(cos, sin, at);
      fly(into, at, dtS);
    }
  }

  /** What is north and east of it, by so much. */
  private static void look(
      float[] north, float[] ownNorth, float[] dx, float[] east, float[] ownEast, float[] dy, int at) {
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector.fromArray(SPECIES, north, at + i)
          .sub(FloatVector.fromArray(SPECIES, ownNorth, at + i))
          .intoArray(dx, i);
      FloatVector.fromArray(SPECIES, east, at + i)
          .sub(FloatVector.fromArray(SPECIES, ownEast, at + i))
          .intoArray(dy, i);
    }
  }

  private void decide(float[] cos, float[] sin, int at) {
    System.arraycopy(seen, 0, arrays, 0, seen.length);
    System.arraycopy(decided, 0, arrays, seen.length, decided.length);
    arrays[KNOWN_COS] = cos;
    arrays[KNOWN_SIN] = sin;
    offsets[KNOWN_COS] = at;
    offsets[KNOWN_SIN] = at;
    function.apply(arrays, offsets, parameters, scratch);
    // What was decided is what the next step begins with.
    swap(OWN_COS, 0);
    swap(OWN_SIN, 1);
    int memories = form.memories();
    for (int i = 0; i < memories; i++) swap(MEMORY + i, 2 + i);
    swap(HEADING, 2 + memories);
  }

  private void swap(int input, int output) {
    float[] before = seen[input];
    seen[input] = decided[output];
    decided[output] = before;
  }

  /** One step of the vehicle under what was decided: {@link ManoeuvreRollout} has the formulas. */
  private void fly(BlockWay way, int at, float dtS) {
    ReducedModel model = opponent.response();
    float[] cos = seen[OWN_COS], sin = seen[OWN_SIN];
    FloatVector dt = FloatVector.broadcast(SPECIES, dtS),
        perLag = FloatVector.broadcast(SPECIES, (float) (dtS / model.lagS())),
        drag = FloatVector.broadcast(SPECIES, (float) (model.dragPerM() * dtS)),
        brake = FloatVector.broadcast(SPECIES, (float) (model.dragPerM() * model.lagS())),
        commanded = FloatVector.broadcast(SPECIES, (float) (opponent.speed() * model.gain())),
        glide1 = FloatVector.broadcast(SPECIES, Glide.GLIDE_1),
        glide2 = FloatVector.broadcast(SPECIES, Glide.GLIDE_2),
        glide3 = FloatVector.broadcast(SPECIES, Glide.GLIDE_3),
        glide4 = FloatVector.broadcast(SPECIES, Glide.GLIDE_4),
        glide5 = FloatVector.broadcast(SPECIES, Glide.GLIDE_5),
        one = FloatVector.broadcast(SPECIES, 1f);
    float[] x = way.x, y = way.y, vx = way.vx, vy = way.vy;
    for (int i = 0, from = at, to = at + SIZE; i < SIZE; i += LANES, from += LANES, to += LANES) {
      FloatVector north = FloatVector.fromArray(SPECIES, vx, from),
          east = FloatVector.fromArray(SPECIES, vy, from);
      FloatVector pace = north.fma(north, east.mul(east)).sqrt();
      FloatVector a = pace.fma(drag, perLag);
      FloatVector slide = a.fma(glide5, glide4).fma(a, glide3).fma(a, glide2).fma(a, glide1);
      FloatVector glided = slide.fma(a, one);
      FloatVector decay = one.sub(glided.mul(a)), glide = glided.mul(dt);
      FloatVector speed = commanded.div(pace.fma(brake, one));
      FloatVector wantedX = FloatVector.fromArray(SPECIES, cos, i).mul(speed),
          wantedY = FloatVector.fromArray(SPECIES, sin, i).mul(speed);
      FloatVector offX = north.sub(wantedX), offY = east.sub(wantedY);
      offX.fma(glide, wantedX.fma(dt, FloatVector.fromArray(SPECIES, x, from))).intoArray(x, to);
      offY.fma(glide, wantedY.fma(dt, FloatVector.fromArray(SPECIES, y, from))).intoArray(y, to);
      offX.fma(decay, wantedX).intoArray(vx, to);
      offY.fma(decay, wantedY).intoArray(vy, to);
    }
  }
}
