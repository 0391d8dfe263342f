package skein.lanes.timetable;

import skein.forward.RolloutAgent;
import skein.lanes.plant.LaneSensors;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LaneObservation;
import skein.lanes.policy.LanePolicy;
import skein.lanes.policy.VehicleNumbers;
import skein.vehicle.SensorNoise;

/** The vehicles of one role in many worlds, simulated by a {@link Timetable}: events happen simultaneously in
 * all worlds, so all that depends only on time is a constant of the timetable, computed by a corresponding
 * {@link EventClock}.
 */
public abstract class TimetableVehicles {
  public static final int WORLDS = LanePolicy.WORLDS;

  /** The readings of the vehicles, and what is predicted from them: by component ({@link LaneObservation#X}
   * and the following constants), then by slot, then by world; empty components down where vehicles fly level.
   */
  public final float[][] seen = new float[LaneObservation.IN_SPACE][0];

  /** Predicts from their readings, in loops that predict; else null. */
  public PredictedVehicles predicted;

  /** Start of each world's vehicle, north, east and down, m. */
  public final float[] startX = new float[WORLDS],
      startY = new float[WORLDS],
      startZ = new float[WORLDS];

  private final boolean inSpace;

  /** Errors of readings; null if these are true. */
  private LaneSensors sensors;

  public TimetableVehicles(RolloutAgent agent) {
    this(agent, false);
  }

  /** @param inSpace whether commands and readings have a vertical part */
  public TimetableVehicles(RolloutAgent agent, boolean inSpace) {
    this.inSpace = inSpace;
    for (int world = 0; world < WORLDS; world++) place(world, agent);
  }

  public final boolean inSpace() {
    return inSpace;
  }

  private void place(int world, RolloutAgent agent) {
    startX[world] = (float) agent.startX();
    startY[world] = (float) agent.startY();
    startZ[world] = (float) agent.altitudeDownM();
  }

  /** Sets where a world's vehicle starts in all later episodes. */
  public final void place(int world, VehicleNumbers numbers) {
    startX[world] = numbers.northM();
    startY[world] = numbers.eastM();
    startZ[world] = numbers.downM();
  }

  /** Resets to the start of an episode.
   *
   * @param readings number of slots that its timetable needs
   * @param worlds number of worlds that count, from the first
   */
  public final void start(int readings, int worlds) {
    if (seen[LaneObservation.X].length < readings * WORLDS)
      for (int component = 0; component < LaneObservation.count(true, inSpace); component++)
        seen[component] = new float[readings * WORLDS];
    start(worlds);
    if (predicted != null) predicted.start(worlds, startZ);
  }

  public abstract void start(int worlds);

  /** Restarts one world: sets its vehicle, and all its readings, to its start at rest.
   *
   * @param headingRad where a car points
   */
  public final void restart(int world, float headingRad) {
    for (int i = world; i < seen[LaneObservation.X].length; i += WORLDS) {
      for (float[] each : seen) if (each.length > 0) each[i] = 0f;
      seen[LaneObservation.X][i] = startX[world];
      seen[LaneObservation.Y][i] = startY[world];
      if (inSpace) seen[LaneObservation.DOWN][i] = startZ[world];
    }
    if (predicted != null) predicted.restart(world, seen);
    rest(world, headingRad);
  }

  /** Sets one world's vehicle to its start, at rest. */
  abstract void rest(int world, float headingRad);

  public final void senseBy(SensorNoise noise) {
    sensors = new LaneSensors(noise, inSpace);
  }

  /** Sets the seeds of the errors of the next episode's readings, if there are any.
   *
   * @param seeds by world
   * @param vehicle index of these vehicles
   */
  public final void seed(long[] seeds, int vehicle) {
    if (sensors != null) sensors.start(seeds, vehicle, true);
  }

  /** Adds the errors of a reading.
   *
   * @param atNs time of the reading
   * @param into the index, for the first world, of the reading
   */
  final void sense(long atNs, int into, boolean withVelocity) {
    sensors.at(atNs);
    for (int read = 0; read < LaneObservation.count(withVelocity, inSpace); read++)
      sensors.add(LaneSensors.componentOf(read), seen[read], into);
  }

  /** Reads the vehicles.
   *
   * @param times the clock's values for this moment, from {@code at} on
   * @param into the index, for the first world, of the reading
   * @param withVelocity whether velocities are read too
   */
  public abstract void look(float[] times, int at, int into, boolean withVelocity);

  /** Lets commands take effect from this moment on.
   *
   * @param from the index, for the first world, of the commanded direction
   */
  abstract void act(float[] times, int at, Directions commanded, int from);
}
