package skein.loop

import skein.policy.{Action, AgentPolicy, Fleet, Observation, PlanarPolicy, Policy, Seen, Sensed, TeamSight}
import skein.forecast.{Estimate, Evidence, Forecast}
import skein.signal.{ClockAlignment, Kinematics, Stamped}
import skein.units.*

/** A command that was sent to a vehicle, as the other vehicles' policies see it.
  *
  * @param speed
  *   absent where the vehicle always commands its own
  * @param action
  *   absent where it is told by heading and speed
  */
final case class Move(
    vehicle: Int,
    decision: Long,
    headingRad: Double,
    sentAt: Instant,
    speed: Option[MetresPerSecond] = None,
    action: Option[Action] = None
)

object Move:
  def of(decision: Decision, sentAt: Instant): Move =
    Move(decision.vehicle, decision.sequence, decision.heading.value, sentAt, decision.speed, decision.action)

/** What the controller knows of the team: the newest reading and the last move of each vehicle, by index, and how the
  * two clocks relate.
  *
  * @param sensed
  *   the newest of each sensor that is read, by vehicle
  * @param forecast
  *   present where the loop predicts
  * @param estimates
  *   of every vehicle when a command decided upon this picture will act; absent where none are made
  */
final case class Picture(
    readings: Vector[Option[Reading]],
    moves: Vector[Option[Move]],
    alignment: Option[ClockAlignment],
    sensed: Vector[Map[String, SensorReading]],
    forecast: Option[Forecast] = None,
    estimates: Option[Vector[Estimate]] = None
):
  def withReading(reading: Reading): Picture =
    copy(
      readings = readings.updated(reading.vehicle, Some(reading)),
      alignment = Some(alignment.fold(ClockAlignment.of(reading.state))(_.updated(reading.state)))
    ).withEvidence(Evidence.Seen(reading.vehicle, reading.state))

  /** Nothing changes where a newer one is held already. */
  def withSensorReading(reading: SensorReading): Picture =
    val held = sensed(reading.vehicle)
    if held.get(reading.sensor).exists(known => !reading.values.isNewerThan(known.values)) then this
    else copy(sensed = sensed.updated(reading.vehicle, held.updated(reading.sensor, reading)))

  def withMove(move: Move): Picture = copy(moves = moves.updated(move.vehicle, Some(move)))

  def withEvidence(evidence: Evidence): Picture = copy(forecast = forecast.map(_.withEvidence(evidence)))

  /** Where a vehicle is taken to be: as estimated, or else as read. */
  def kinematics(vehicle: Int): Kinematics =
    estimates.fold(readings(vehicle).get.state.value)(_(vehicle).kinematics)

  /** Commanded last to a vehicle, as far as known; before the first command that of the start. */
  def headingRad(vehicle: Int, fleet: Fleet): Double =
    moves(vehicle).fold(fleet.agents(vehicle).startHeading.value)(_.headingRad)

  /** Whether a reading is newer than the one held: a late answer never overrides a newer one. */
  def isNews(reading: Reading): Boolean =
    readings(reading.vehicle).forall(held => reading.state.isNewerThan(held.state))

  /** Whether every vehicle was seen at least once; only then can be decided. */
  def isComplete: Boolean = readings.forall(_.isDefined)

object Picture:
  def empty(vehicles: Int): Picture =
    Picture(Vector.fill(vehicles)(None), Vector.fill(vehicles)(None), None, Vector.fill(vehicles)(Map.empty))

/** What one vehicle's decisions depend on apart from the picture.
  *
  * @param held
  *   what the policy remembers; of its own type
  */
final case class Memory(headingRad: Double, decidedAt: Option[Instant], decisions: Long, held: Any = ())

/** Decisions for one vehicle of a scenario: the pure core of every loop.
  *
  * @param policy
  *   the agent's own, or one in its place
  */
final class Decider(scenario: Fleet, self: Int, policy: AgentPolicy):
  private val agent = scenario.agents(self)

  def this(scenario: Fleet, self: Int) = this(scenario, self, scenario.agents(self).policy)

  val start: Memory = Memory(agent.startHeading.value, None, 0, policy.start)

  /** Decides from a complete picture.
    *
    * @param now
    *   on the clock that the readings' `receivedAt` and the moves' `sentAt` were read from
    */
  def decide(memory: Memory, picture: Picture, now: Instant): (Memory, Decision) =
    val seen = observation(memory, picture, now)
    // A memory comes from this policy alone: from its start, or from its last decision.
    policy match
      case planar: PlanarPolicy =>
        val (chosen, held)   = planar.planar(seen, memory.held.asInstanceOf[planar.Memory])
        val (next, decision) = decided(memory, picture, now, chosen.heading.value, chosen.speed)
        (next.copy(held = held), decision)
      case _ =>
        val (action, held)   = policy.choose(seen, memory.held.asInstanceOf[policy.Memory])
        val (next, decision) =
          decided(
            memory,
            picture,
            now,
            Acting.headingRad(action, memory.headingRad),
            Some(Acting.speed(action))
          )
        (next.copy(held = held), decision.copy(action = Some(action)))

  def regardsTeam: Boolean = policy match
    case _: Policy => false
    case _         => true

  /** What the vehicle's policy decides upon. */
  def observation(memory: Memory, picture: Picture, now: Instant): Observation =
    val places = scenario.agents.indices.toVector
    Observation(
      self,
      places.map(seen(picture, now, _)),
      opponentIn(picture),
      places.map(place =>
        Radians(if place == self then memory.headingRad else picture.headingRad(place, scenario))
      ),
      elapsed(memory, now),
      memory.decisions,
      agent.speed,
      Metres(agent.startPositionNed.z),
      picture.sensed(self).map: (sensor, reading) =>
        sensor -> Sensed(reading.columns, reading.values.value, age(picture, now, reading.values))
    )

  private def seen(picture: Picture, now: Instant, vehicle: Int): Seen =
    val reading = picture.readings(vehicle).get.state
    Seen(picture.kinematics(vehicle), age(picture, now, reading), isPredicted = picture.estimates.isDefined)

  private def age(picture: Picture, now: Instant, reading: Stamped[?]): Span =
    picture.alignment.fold(reading.ageByArrival(now))(known => now.since(known.toController(reading.validAt)))

  /** What the vehicle knows of its team. */
  def sight(memory: Memory, picture: Picture, now: Instant): TeamSight =
    TeamSight.of(observation(memory, picture, now))

  private def elapsed(memory: Memory, now: Instant): Span = memory.decidedAt.fold(Span.Zero)(now.since)

  private def opponentIn(picture: Picture): Int =
    scenario.opponentOf(self, picture.kinematics(_).positionNed)

  /** The decision for a course that was chosen, however that was done.
    *
    * @param speed
    *   absent where the vehicle commands its own
    */
  def decided(
      memory: Memory,
      picture: Picture,
      now: Instant,
      heading: Double,
      speed: Option[MetresPerSecond]
  ): (Memory, Decision) =
    val decision = Decision(
      vehicle = self,
      sequence = memory.decisions,
      decidedAt = now,
      picture = picture,
      opponent = opponentIn(picture),
      headingBefore = Radians(memory.headingRad),
      elapsed = elapsed(memory, now),
      heading = Radians(heading),
      speed = speed
    )
    (memory.copy(headingRad = heading, decidedAt = Some(now), decisions = memory.decisions + 1), decision)
