package skein.lanes.policy;

import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import skein.simd.LaneFunction;

/** Policies of one form in many worlds, each with its own parameters, compiled from the policy itself ({@link
 * PolicyLanes}); {@code LanePolicySimulation} compares them with it. Mutable: one per kernel and role.
 */
public class LanePolicy {
  public static final int WORLDS = LaneObservation.WORLDS;

  private static final PolicyLanes.In$ in = PolicyLanes.In$.MODULE$;

  private final PolicyLanes form;
  private final LaneFunction function;
  private final float[] parameters, scratch;

  /** Arguments of the compiled function: the inputs, the outputs, this vehicle's readings. */
  public final float[][] arrays;

  public final int[] offsets;

  /** Arguments of the function that observes; made when it is first called. */
  private float[][] observing;

  private int[] observingAt;
  private float[] observingScratch;

  /** The memory of each world's policy, by component, then by world: initially, now, and after the
   * decision. */
  private final float[] initial;

  public final float[] memory, newMemory;

  /** Change of each world's decided heading from the one before, by the shorter way, rad; 0 without efforts.
   */
  public final float[] turned = new float[WORLDS];

  /** The last commanded heading, rad, for policies that turn from it, and the decided one. */
  public final float[] heading = new float[WORLDS], newHeading = new float[WORLDS];

  private final boolean withEffort;

  private int worlds = WORLDS;

  /** Number of outputs for directions and changes of heading, which precede the memory. */
  private final int decided;

  /** @param withEffort whether {@link #turned} is needed */
  public LanePolicy(PolicyLanes form, boolean withEffort) {
    this.form = form;
    this.withEffort = withEffort;
    int unasked = withEffort ? 0 : 1;
    decided = form.decided() - unasked;
    function = withEffort ? form.function() : form.functionWithoutEffort();
    parameters = new float[LaneFunction.places(form.parameters())];
    scratch = new float[function.scratch()];
    // This vehicle's readings are last.
    int unread = form.memories() - form.remembered();
    arrays = new float[form.inputs() + form.outputs().size() - unasked - unread + LaneObservation.READ][];
    offsets = new int[arrays.length];
    initial = new float[form.memories() * WORLDS];
    memory = new float[initial.length];
    newMemory = new float[initial.length];
  }

  /** Sets the parameters and initial memory of a world's policy, which must be of this form. */
  public void put(int world, VehicleNumbers numbers) {
    float[] values = numbers.policy();
    int count = numbers.parameters();
    for (int i = 0; i < count; i++) parameters[place(i, world)] = values[i];
    for (int i = count; i < values.length; i++) initial[(i - count) * WORLDS + world] = values[i];
  }

  private int place(int parameter, int world) {
    return LaneFunction.place(parameter, world, form.parameters());
  }

  /** Whether its policies use the velocities of the observation. */
  public boolean needsVelocity() {
    return form.needsVelocity();
  }

  /** Whether its policies use the ages of the observation's readings. */
  public boolean needsAges() {
    return form.needsAges();
  }

  /** Decides in all worlds. {@code own} are the last commanded directions, {@code known} those of the
   * opponent; the decided ones are stored in {@code into}. Each begins at its offset. {@link #turned}
   * receives the change from the last commanded direction.
   */
  public void decide(
      LaneObservation observation,
      Directions own,
      int ownAt,
      Directions known,
      int knownAt,
      Directions into,
      int intoAt) {
    look(arrays, offsets, observation, own, ownAt, known, knownAt);
    int outputs = form.inputs(), remembered = form.remembered();
    for (int i = 0; i < remembered; i++)
      set(arrays, offsets, outputs + decided + i, newMemory, i * WORLDS);
    set(arrays, offsets, outputs, into.cos, intoAt);
    set(arrays, offsets, outputs + 1, into.sin, intoAt);
    if (withEffort) set(arrays, offsets, outputs + 2, turned, 0);
    if (form.keepsHeading()) set(arrays, offsets, outputs + decided + remembered, newHeading, 0);
    function.apply(arrays, offsets, parameters, scratch, worlds);
  }

  /** Computes the memory on which no decision depends, without deciding. The arguments are those of {@link
   * #decide}.
   */
  public void observe(
      LaneObservation observation, Directions own, int ownAt, Directions known, int knownAt) {
    int outputs = form.inputs(), remembered = form.remembered();
    if (observing == null) {
      observing = new float[outputs + form.memories() - remembered + LaneObservation.READ][];
      observingAt = new int[observing.length];
      observingScratch = new float[form.observing().scratch()];
      for (int i = remembered; i < form.memories(); i++)
        set(observing, observingAt, outputs + i - remembered, newMemory, i * WORLDS);
    }
    look(observing, observingAt, observation, own, ownAt, known, knownAt);
    form.observing().apply(observing, observingAt, parameters, observingScratch, worlds);
  }

  private void look(
      float[][] arrays,
      int[] offsets,
      LaneObservation observation,
      Directions own,
      int ownAt,
      Directions known,
      int knownAt) {
    for (int i = 0; i < LaneObservation.READ; i++) {
      set(arrays, offsets, i, observation.opponent[i], observation.opponentAt[i]);
      int last = arrays.length - LaneObservation.READ + i;
      set(arrays, offsets, last, observation.own[i], observation.ownAt[i]);
    }
    set(arrays, offsets, in.Elapsed(), observation.elapsed, 0);
    set(arrays, offsets, in.OwnCos(), own.cos, ownAt);
    set(arrays, offsets, in.OwnSin(), own.sin, ownAt);
    set(arrays, offsets, in.KnownCos(), known.cos, knownAt);
    set(arrays, offsets, in.KnownSin(), known.sin, knownAt);
    set(arrays, offsets, in.Heading(), heading, 0);
    set(arrays, offsets, in.OwnAge(), observation.ownAge, 0);
    set(arrays, offsets, in.OpponentAge(), observation.opponentAge, 0);
    for (int i = 0; i < form.memories(); i++)
      set(arrays, offsets, in.Memory() + i, memory, i * WORLDS);
  }

  private static void set(float[][] arrays, int[] offsets, int place, float[] array, int offset) {
    // Nearly always unchanged; storing a reference would cost the collector's bookkeeping.
    if (arrays[place] != array) arrays[place] = array;
    offsets[place] = offset;
  }

  /** Resets to the start of an episode, of which the first worlds count. */
  public void start(float headingRad, int worlds) {
    this.worlds = worlds;
    Arrays.fill(heading, headingRad);
    System.arraycopy(initial, 0, memory, 0, initial.length);
  }

  public void restart(int world, float headingRad) {
    heading[world] = headingRad;
    for (int i = world; i < memory.length; i += WORLDS) memory[i] = initial[i];
  }

  /** Makes the decisions of all worlds the last commands.
   *
   * @param effort receives the sums of the heading's changes
   */
  public void commit(float[] effort) {
    if (form.keepsHeading()) System.arraycopy(newHeading, 0, heading, 0, WORLDS);
    System.arraycopy(newMemory, 0, memory, 0, form.remembered() * WORLDS);
    if (!withEffort) return;
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, effort, i)
          .add(FloatVector.fromArray(SPECIES, turned, i))
          .intoArray(effort, i);
  }

  /** Stores the decisions of worlds whose time is earlier than another. */
  public void rememberBefore(int[] times, int before) {
    for (int i = 0; i < memory.length; i++)
      if (times[i % WORLDS] < before) memory[i] = newMemory[i];
  }
}
