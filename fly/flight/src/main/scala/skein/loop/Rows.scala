package skein.loop

import skein.policy.{Action, Agent, Fleet, Role, Yaw}
import skein.record.{
  CommandRow,
  DecisionRow,
  MeasurementRow,
  Observations,
  PlannedStates,
  Predicted,
  PredictedMotion,
  ReadingRow,
  Sensing,
  Sighting,
  TrueAge
}
import skein.units.*

/** Converts a loop's messages to rows for its recorder. */
private final class Rows(fleet: Fleet):

  def name(vehicle: Int): String = fleet.agents(vehicle).name

  def reading(read: Reading): ReadingRow = ReadingRow(read.sequence, name(read.vehicle), read.state)

  def measurement(read: SensorReading): MeasurementRow =
    import read.values.{receivedAt, sentAt, validAt, value}
    MeasurementRow(
      read.sequence,
      name(read.vehicle),
      read.sensor,
      read.columns,
      value,
      validAt,
      sentAt,
      receivedAt
    )

  def decision(decision: Decision): DecisionRow =
    import decision.{opponent as other, view, vehicle as self}
    val now             = decision.decidedAt
    val own             = view.readings(self).get
    val opponent        = view.readings(other).get
    val opponentHeading =
      view.moves(other).fold(view.seenHeadingRad(other, fleet))(_.heading.value)
    val (here, there)              = (view.kinematics(self), view.kinematics(other))
    val toOpponent                 = there.positionNed - here.positionNed
    val (toEvader, pursuerHeading) = fleet.agents(self).role match
      case Role.Evader => (toOpponent * -1, opponentHeading)
      case _           => (toOpponent, decision.headingBefore.value)
    val (cos, sin) = (StrictMath.cos(pursuerHeading), StrictMath.sin(pursuerHeading))
    DecisionRow(
      sequence = decision.sequence,
      vehicle = name(self),
      decidedAt = now,
      own = reading(own),
      opponent = reading(opponent),
      relativeX = Metres(toEvader.x * cos + toEvader.y * sin),
      relativeY = Metres(-toEvader.x * sin + toEvader.y * cos),
      headingBefore = decision.headingBefore,
      opponentHeading = Radians(opponentHeading),
      heading = decision.heading,
      elapsed = decision.elapsed,
      observations = Observations(
        ownAge = own.state.ageByArrival(now),
        opponentAge = opponent.state.ageByArrival(now),
        sinceOwnMove = view.moves(self).map(move => now.since(move.sentAt)),
        sinceOpponentMove = view.moves(other).map(move => now.since(move.sentAt))
      ),
      trueAge =
        for
          alignment <- view.alignment
          ownAge    <- alignment.ageOf(own.state, now)
          otherAge  <- alignment.ageOf(opponent.state, now)
        yield TrueAge(
          own = ownAge,
          opponent = otherAge,
          clockOffset = alignment.offset,
          uncertainty = alignment.uncertainty
        ),
      predicted = view.estimates.map(estimates =>
        Predicted(
          estimates(self).predictedFor,
          here.positionNed,
          here.velocityNed,
          there.positionNed,
          there.velocityNed
        )
      ),
      speed = speedColumn(decision.action, fleet.agents(self)),
      action = actionColumn(decision.action, fleet.agents(self))
    )

  /** The recorded speed: absent for the vehicle's own, if its policy plays against one opponent. */
  private def speedColumn(action: Action, agent: Agent): Option[MetresPerSecond] = action match
    case Action.Along(_, agent.speed, _, Yaw.Still) if agent.policy.isAgainstOne => None
    case _                                                                       => Some(action.speed)

  /** The recorded action: absent for a heading at the altitude of the start. */
  private def actionColumn(action: Action, agent: Agent): Option[Action] = action match
    case Action.Along(_, _, down, Yaw.Still) if down == startDown(agent) => None
    case _                                                               => Some(action.byVelocity)

  /** The action of a recorded decision for an agent. */
  def action(recorded: DecisionRow, agent: Agent): Action =
    def along(down: Metres, yaw: Yaw) =
      Action.Along(recorded.heading, recorded.speed.getOrElse(agent.speed), down, yaw)
    recorded.action match
      case None                                                => along(startDown(agent), Yaw.Still)
      case Some(velocity @ Action.VelocityAt(_, _, down, yaw)) =>
        // A flight along a heading at another altitude is recorded as its velocity.
        Some(along(down, yaw)).filter(_.byVelocity == velocity).getOrElse(velocity)
      case Some(other) => other

  private def startDown(agent: Agent) = Metres(agent.startPositionNed.z)

  /** The other vehicles that a decision used besides its opponent, if it considered the whole team. */
  def sighted(decision: Decision): Vector[Int] =
    fleet.agents.indices.filter(other => other != decision.vehicle && other != decision.opponent).toVector

  def sighting(decision: Decision, other: Int): Sighting = Sighting(
    name(decision.vehicle),
    decision.sequence,
    name(other),
    decision.view.readings(other).get.sequence,
    decision.view.estimates.map: estimates =>
      val expected = estimates(other).kinematics
      PredictedMotion(expected.positionNed, expected.velocityNed)
  )

  /** The plants' states from which a decision was planned, if kinematics do not contain them. */
  def plannedStates(decision: Decision): Option[PlannedStates] =
    decision.view.estimates
      .map(estimates => PlannedStates(estimates(decision.vehicle).state, estimates(decision.opponent).state))
      .filter(states => states.own.nonEmpty || states.opponent.nonEmpty)

  /** The sensors that a decision used, by name. */
  def sensed(decision: Decision): Vector[String] =
    decision.view.sensed(decision.vehicle).keys.toVector.sorted

  def sensing(decision: Decision, sensor: String): Sensing =
    val reading = decision.view.sensed(decision.vehicle)(sensor)
    Sensing(name(decision.vehicle), decision.sequence, sensor, reading.sequence)

  /** The row of a decision that was sent as a command. */
  def command(decision: Decision, at: Instant): CommandRow =
    val agent    = fleet.agents(decision.vehicle)
    val velocity = agent.velocityNed(decision.heading.value, Some(decision.action.speed))
    CommandRow(
      decision.sequence,
      agent.name,
      Some(decision.sequence),
      MetresPerSecond(velocity.x),
      MetresPerSecond(velocity.y),
      decision.action match
        case Action.VelocityAt(_, _, down, _) => down
        case Action.Along(_, _, down, _)      => down
        case _                                => startDown(agent)
      ,
      at
    )
