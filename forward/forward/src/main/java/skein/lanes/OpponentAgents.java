package skein.lanes;

import java.util.Arrays;
import skein.forward.RolloutAgent;
import skein.lanes.policy.Directions;
import skein.lanes.policy.LaneObservation;
import skein.lanes.policy.LanePolicy;
import skein.lanes.policy.VehicleNumbers;
import skein.lanes.timetable.Timetable;
import skein.lanes.timetable.TimetableAgents;
import skein.lanes.timetable.TimetableEye;
import skein.lanes.timetable.TimetableVehicles;

/** One of two opponents in many worlds: decides by the difference of their readings. */
final class OpponentAgents extends TimetableAgents implements TeamMember {
  private final LanePolicy policy;
  private final float[] effort = new float[WORLDS];
  private final float startHeading;
  private final int self;
  private final LaneObservation observation = new LaneObservation();

  /** The camera that is the vehicle's only source about its opponent; null if it reads the opponent. */
  private final TimetableEye eye;

  /** @param self the vehicle's index, 0 or 1
   * @param eye the camera that is its only source about its opponent; null if it reads the opponent
   */
  OpponentAgents(
      int self,
      RolloutAgent agent,
      LaneDynamics model,
      LanePolicy policy,
      TimetableEye eye) {
    super(model.vehicles(agent));
    this.eye = eye;
    this.self = self;
    this.policy = policy;
    startHeading = (float) agent.startHeadingRad();
  }

  @Override
  public void take(int world, VehicleNumbers numbers) {
    vehicles.place(world, numbers);
    policy.put(world, numbers);
  }

  @Override
  public float[] effortRad() {
    return effort;
  }

  @Override
  public void start(Timetable timetable, int worlds) {
    super.start(timetable, worlds);
    // The timetable keeps the first heading in slot 0.
    headings.fill(0, WORLDS, startHeading);
    policy.start(startHeading, worlds);
    if (eye != null) eye.start(worlds);
    Arrays.fill(effort, 0f);
  }

  @Override
  public void restart(int world, float headingRad) {
    vehicles.restart(world, headingRad);
    policy.restart(world, headingRad);
    float cos = (float) StrictMath.cos(headingRad), sin = (float) StrictMath.sin(headingRad);
    headings.point(world, WORLDS, cos, sin);
  }

  @Override
  public boolean needsVelocity() {
    return policy.needsVelocity();
  }

  @Override
  public void decide(
      TimetableAgents[] all,
      int[] views,
      int view,
      int known,
      int before,
      int after,
      float[] times,
      int number) {
    see(all, views, view, times, number);
    Directions theirs = eye == null ? all[1 - self].headings : eye.heading();
    policy.decide(observation, headings, before, theirs, eye == null ? known : 0, headings, after);
    policy.commit(effort);
  }

  @Override
  public void observe(
      TimetableAgents[] all, int[] views, int view, int known, int before, float[] times, int number) {
    see(all, views, view, times, number);
    policy.observe(observation, headings, before, all[1 - self].headings, known);
  }

  @Override
  public float[] memory() {
    return policy.memory;
  }

  @Override
  public float[] nextMemory() {
    return policy.newMemory;
  }

  private void see(TimetableAgents[] all, int[] views, int view, float[] times, int number) {
    if (eye != null) {
      believe(views[view + self] * WORLDS, times, number);
      return;
    }
    TimetableVehicles ours = vehicles, theirs = all[1 - self].vehicles;
    int ownSeen = views[view + self] * WORLDS,
        opponentSeen = views[view + 1 - self] * WORLDS;
    int count = LaneObservation.count(needsVelocity(), false);
    for (int what = 0; what < count; what++)
      observation.see(what, theirs.seen[what], opponentSeen, ours.seen[what], ownSeen);
    Arrays.fill(observation.elapsed, times[number]);
    if (policy.needsAges()) {
      Arrays.fill(observation.ownAge, times[number + 1]);
      Arrays.fill(observation.opponentAge, times[number + 2]);
    }
  }

  /** Fills the observation of a decision by the estimate of the camera. */
  private void believe(int ownSeen, float[] times, int number) {
    eye.look(vehicles, ownSeen, times[number + 2], times[number + 3]);
    observation.seeFromOwn(LaneObservation.X, eye.northM());
    observation.seeFromOwn(LaneObservation.Y, eye.eastM());
    if (needsVelocity()) {
      observation.see(LaneObservation.VX, eye.northMps(), 0, vehicles.seen[LaneObservation.VX], ownSeen);
      observation.see(LaneObservation.VY, eye.eastMps(), 0, vehicles.seen[LaneObservation.VY], ownSeen);
    }
    Arrays.fill(observation.elapsed, times[number]);
    Arrays.fill(observation.ownAge, times[number + 1]);
    System.arraycopy(eye.ageS(), 0, observation.opponentAge, 0, WORLDS);
  }

  @Override
  public void expose(TimetableAgents[] all, int[] views, int view, int image, float[] times, int number) {
    eye.expose(
        image,
        vehicles,
        views[view + self] * WORLDS,
        all[1 - self].vehicles,
        views[view + 1 - self] * WORLDS,
        times,
        number);
  }

  @Override
  public void join(int image, boolean isOlder, int last) {
    eye.join(image, isOlder, last);
  }
}
