package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** Predicts horizontal motion by a plant; altitude and orientation stay as in the last reading. A setpoint
  * that is not a velocity means "stand still".
  */
final case class PlantModel[S](plant: ObservedPlant[S]) extends VehicleModel[PlantModel.Flying[S]]:
  import PlantModel.*

  private val deadTime = Span.ofSeconds(plant.deadTimeS)

  def start(seen: Kinematics): Flying[S] =
    Flying(seen, plant.corrected(plant.initial, readingOf(seen)), Still, Still, Vector.empty)

  def advanced(flying: Flying[S], setpoint: Setpoint, span: Span): Flying[S] =
    val told         = velocityOf(setpoint)
    val coming       = if told == flying.told then flying.coming else flying.coming :+ Coming(told, deadTime)
    val (due, later) = coming.partition(_.in <= span)
    val flight       = PlantFlight(plant)
    flight.start(0, flying.state, flying.acting.x, flying.acting.y)
    for command <- due do flight.act(command.in.toSeconds, command.velocityNed.x, command.velocityNed.y)
    flight.advance(span.toSeconds)
    val seen    = flying.now
    val reading = flight.reading
    val down    = seen.positionNed.z + seen.velocityNed.z * span.toSeconds
    Flying(
      seen.copy(
        positionNed = Vector3(reading.northM, reading.eastM, down),
        velocityNed = Vector3(reading.northMps, reading.eastMps, seen.velocityNed.z)
      ),
      flight.state,
      due.lastOption.fold(flying.acting)(_.velocityNed),
      told,
      later.map(command => command.copy(in = command.in - span))
    )

  def corrected(flying: Flying[S], seen: Kinematics, sinceSeen: Span): Flying[S] =
    flying.copy(now = seen, state = plant.corrected(flying.state, readingOf(seen)))

  def kinematics(flying: Flying[S]): Kinematics = flying.now

  override def numbers: Flying[S] => Vector[Double] = _.state match
    case _: PlaneReading => Vector.empty
    case state           => PlantState.numbers(state)

object PlantModel:

  /** State of a prediction.
    *
    * @param acting the commanded velocity in effect, m/s
    * @param told the last command received, m/s
    * @param coming received commands that are not in effect yet, the oldest first
    */
  final case class Flying[S] private[vehicle] (
      now: Kinematics,
      state: S,
      acting: Vector3,
      told: Vector3,
      coming: Vector[Coming]
  )

  /** A command within its dead time.
    *
    * @param in time until it takes effect
    */
  final case class Coming private[vehicle] (velocityNed: Vector3, in: Span)

  private val Still = Vector3.Zero

  private[skein] def readingOf(seen: Kinematics): PlaneReading =
    PlaneReading(seen.positionNed.x, seen.positionNed.y, seen.velocityNed.x, seen.velocityNed.y)

  private def velocityOf(setpoint: Setpoint): Vector3 =
    if setpoint.horizontal == HorizontalMode.Velocity then Vector3(setpoint.first, setpoint.second, 0)
    else Still
