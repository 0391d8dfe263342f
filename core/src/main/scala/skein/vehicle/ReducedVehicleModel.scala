package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** Predicts by a [[ReducedModel]], horizontally; the altitude goes on as it was seen. Setpoints that are no velocities
  * are taken as "stand still". Orientation stays as seen.
  */
final case class ReducedVehicleModel(model: ReducedModel) extends VehicleModel[ReducedVehicleModel.Flying]:
  import ReducedVehicleModel.*

  private val deadTime = Span.ofSeconds(model.deadTimeS)

  def start(seen: Kinematics): Flying = Flying(seen, Still, Still, Vector.empty)

  def advanced(flying: Flying, setpoint: Setpoint, span: Span): Flying =
    val told         = velocityOf(setpoint)
    val coming       = if told == flying.told then flying.coming else flying.coming :+ Coming(told, deadTime)
    val (due, later) = coming.partition(_.in <= span)
    val flight       = ReducedFlight(model)
    val seen         = flying.now
    flight.start(
      0,
      seen.positionNed.x,
      seen.positionNed.y,
      seen.velocityNed.x,
      seen.velocityNed.y,
      flying.acting.x,
      flying.acting.y
    )
    for command <- due do flight.act(command.in.toSeconds, command.velocityNed.x, command.velocityNed.y)
    flight.advance(span.toSeconds)
    val down = seen.positionNed.z + seen.velocityNed.z * span.toSeconds
    Flying(
      seen.copy(
        positionNed = Vector3(flight.x, flight.y, down),
        velocityNed = Vector3(flight.vx, flight.vy, seen.velocityNed.z)
      ),
      due.lastOption.fold(flying.acting)(_.velocityNed),
      told,
      later.map(command => command.copy(in = command.in - span))
    )

  def corrected(flying: Flying, seen: Kinematics, sinceSeen: Span): Flying = flying.copy(now = seen)

  def kinematics(flying: Flying): Kinematics = flying.now

object ReducedVehicleModel:

  /** @param acting
    *   the commanded velocity that acts, m/s
    * @param told
    *   the one that came last
    * @param coming
    *   what has come and does not act yet, the oldest first
    */
  final case class Flying private[vehicle] (
      now: Kinematics,
      acting: Vector3,
      told: Vector3,
      coming: Vector[Coming]
  )

  /** @param in
    *   until it acts
    */
  final case class Coming private[vehicle] (velocityNed: Vector3, in: Span)

  private val Still = Vector3.Zero

  private def velocityOf(setpoint: Setpoint): Vector3 =
    if setpoint.horizontal == HorizontalMode.Velocity then Vector3(setpoint.first, setpoint.second, 0)
    else Still
