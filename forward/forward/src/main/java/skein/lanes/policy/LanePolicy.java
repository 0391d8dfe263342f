package skein.lanes.policy;

import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import skein.policy.HeadingPolicy;
import skein.simd.LaneFunction;

/**
 * Policies of one form in many worlds, each with parameters of its own, compiled from the policy
 * itself ({@link PolicyLanes}); {@code LanePolicySimulation} holds them to it. Mutable: one per kernel
 * and role.
 */
public class LanePolicy {
  /** Worlds that decide together. */
  public static final int WORLDS = LaneObservation.WORLDS;

  private final PolicyLanes form;
  private final LaneFunction function;
  private final float[] parameters, scratch;

  /** What the function reads and writes: the inputs, the outputs, the own readings. */
  public final float[][] arrays;

  public final int[] offsets;

  /** What each world's policy remembers, by number, then by world: at first, now, and after the decision. */
  private final float[] initial, memory, newMemory;

  /**
   * How far each world's decided heading is from the one before, by the shorter way, rad; 0 without efforts.
   */
  public final float[] turned = new float[WORLDS];

  /** The heading commanded last, rad, for policies that turn from it, and the one decided. */
  public final float[] heading = new float[WORLDS], newHeading = new float[WORLDS];

  private final boolean withEffort;

  private int worlds = WORLDS;

  /** So many directions and changes of the heading are decided, before what is remembered. */
  private final int decided;

  /**
   * @param withEffort whether {@link #turned} is asked for
   */
  public LanePolicy(PolicyLanes form, boolean withEffort) {
    this.form = form;
    this.withEffort = withEffort;
    int unasked = withEffort ? 0 : 1;
    decided = form.decided() - unasked;
    function = withEffort ? form.function() : form.functionWithoutEffort();
    parameters = new float[LaneFunction.places(form.parameters())];
    scratch = new float[function.scratch()];
    // What the own readings tell comes last.
    arrays = new float[form.inputs() + form.outputs().size() - unasked + LaneObservation.READ][];
    offsets = new int[arrays.length];
    initial = new float[form.memories() * WORLDS];
    memory = new float[initial.length];
    newMemory = new float[initial.length];
  }

  public LanePolicy(PolicyLanes form) {
    this(form, true);
  }

  /** Lanes that fly policies of this policy's form, which must be a formula. */
  public static LanePolicy of(HeadingPolicy policy) {
    return of(policy, true);
  }

  public static LanePolicy of(HeadingPolicy policy, boolean withEffort) {
    return new LanePolicy(PolicyLanes.get(policy), withEffort);
  }

  /** Takes the parameters that a world flies by from now on; the policy must be of this form. */
  public void take(int world, HeadingPolicy policy) {
    if (!form.fits(policy)) throw new IllegalArgumentException(policy + " is of another form");
    put(world, policy);
  }

  /** The same of a policy that is known to be of this form. */
  public void put(int world, HeadingPolicy policy) {
    double[] values = form.parametersOf(policy);
    for (int i = 0; i < values.length; i++) parameters[place(i, world)] = (float) values[i];
    double[] remembered = form.initialOf(policy);
    for (int i = 0; i < remembered.length; i++)
      initial[i * WORLDS + world] = (float) remembered[i];
  }

  private int place(int parameter, int world) {
    return LaneFunction.place(parameter, world, form.parameters());
  }

  /** A world flies by the policy that another does. */
  public void copy(int from, int to) {
    for (int i = 0; i < form.parameters(); i++) parameters[place(i, to)] = parameters[place(i, from)];
    for (int i = 0; i < initial.length; i += WORLDS) initial[i + to] = initial[i + from];
  }

  /** Whether it looks at the velocities of the observation. */
  public boolean needsVelocity() {
    return form.needsVelocity();
  }

  /** Whether it asks how old the observation's readings are. */
  public boolean needsAges() {
    return form.needsAges();
  }

  /**
   * Decides in all worlds. {@code own} are the directions commanded last, {@code known} those of the
   * opponent; the decided ones go to {@code into}. Each begins at its offset. {@link #turned} is
   * what they differ by from the own.
   */
  public void decide(
      LaneObservation observation,
      Directions own,
      int ownAt,
      Directions known,
      int knownAt,
      Directions into,
      int intoAt) {
    // In the order of PolicyLanes.In, then of the outputs.
    for (int i = 0; i < LaneObservation.READ; i++) {
      set(i, observation.opponent[i], observation.opponentAt[i]);
      set(arrays.length - LaneObservation.READ + i, observation.own[i], observation.ownAt[i]);
    }
    set(4, observation.elapsed, 0);
    set(5, own.cos, ownAt);
    set(6, own.sin, ownAt);
    set(7, known.cos, knownAt);
    set(8, known.sin, knownAt);
    set(9, heading, 0);
    set(10, observation.ownAge, 0);
    set(11, observation.opponentAge, 0);
    int outputs = form.inputs(), memories = form.memories();
    for (int i = 0; i < memories; i++) {
      set(12 + i, memory, i * WORLDS);
      set(outputs + decided + i, newMemory, i * WORLDS);
    }
    set(outputs, into.cos, intoAt);
    set(outputs + 1, into.sin, intoAt);
    if (withEffort) set(outputs + 2, turned, 0);
    if (form.keepsHeading()) set(outputs + decided + memories, newHeading, 0);
    function.apply(arrays, offsets, parameters, scratch, worlds);
  }

  private void set(int place, float[] array, int offset) {
    // Nearly always the same one: to store a reference costs the collector's bookkeeping.
    if (arrays[place] != array) arrays[place] = array;
    offsets[place] = offset;
  }

  /** Back to the start of an episode, of which the first worlds count. */
  public void start(float headingRad, int worlds) {
    this.worlds = worlds;
    Arrays.fill(heading, headingRad);
    System.arraycopy(initial, 0, memory, 0, initial.length);
  }

  /** One world's policy begins anew. */
  public void restart(int world, float headingRad) {
    heading[world] = headingRad;
    for (int i = world; i < memory.length; i += WORLDS) memory[i] = initial[i];
  }

  /** Tells one world's policy of a single number that number. */
  public void tell(int world, float number) {
    parameters[place(0, world)] = number;
  }

  /**
   * All worlds' decisions become commands.
   *
   * @param effort where the changes of the heading are added up
   */
  public void commit(float[] effort) {
    if (form.keepsHeading()) System.arraycopy(newHeading, 0, heading, 0, WORLDS);
    System.arraycopy(newMemory, 0, memory, 0, memory.length);
    if (!withEffort) return;
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, effort, i)
          .add(FloatVector.fromArray(SPECIES, turned, i))
          .intoArray(effort, i);
  }

  /** What was decided is remembered in the worlds whose time, from a place on, comes before another. */
  public void rememberBefore(int[] times, int from, int before) {
    for (int i = 0; i < memory.length; i++)
      if (times[from + i % WORLDS] < before) memory[i] = newMemory[i];
  }
}
