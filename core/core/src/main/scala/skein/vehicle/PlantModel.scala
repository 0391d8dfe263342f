package skein.vehicle

import skein.signal.Kinematics
import skein.units.*

/** Predicts horizontal motion with a plant; altitude and orientation stay as in the last reading. A setpoint
  * that is not a velocity means "stand still".
  */
final case class PlantModel[S](plant: ObservedPlant[S]) extends VehicleModel[PlantModel.Flying[S]]:
  import PlantModel.*

  private val deadTime = Span.ofSeconds(plant.deadTimeS)

  def start(seen: Kinematics): Flying[S] =
    Flying(seen, plant.corrected(plant.initial, readingOf(seen)), PendingCommands.resting(Vector3.Zero))

  def advanced(flying: Flying[S], setpoint: Setpoint, span: Span): Flying[S] =
    val (due, commands) = flying.commands.after(velocityOf(setpoint), deadTime, span)
    val flight          = PlantFlight(plant)
    val acting          = flying.commands.acting
    flight.start(0, flying.state, acting.x, acting.y)
    for next <- due do flight.act(next.in.toSeconds, next.command.x, next.command.y)
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
      commands
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
    * @param commands velocities, m/s
    */
  final case class Flying[S] private[vehicle] (
      now: Kinematics,
      state: S,
      private[vehicle] val commands: PendingCommands[Vector3]
  )

  private[skein] def readingOf(seen: Kinematics): PlaneReading =
    PlaneReading(seen.positionNed.x, seen.positionNed.y, seen.velocityNed.x, seen.velocityNed.y)

  private def velocityOf(setpoint: Setpoint): Vector3 =
    if setpoint.horizontal == HorizontalMode.Velocity then Vector3(setpoint.first, setpoint.second, 0)
    else Vector3.Zero
