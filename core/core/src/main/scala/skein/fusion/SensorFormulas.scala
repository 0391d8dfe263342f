package skein.fusion

import skein.fusion.SensorFormulas.*
import skein.policy.CameraPursuer
import skein.units.{Instant, Vector3}

/** The computations of [[SensorModel]], of its filter, and of [[skein.policy.CameraPursuer]], on plain
  * numbers, so that compilers can trace them. Times are in seconds since the flight's start.
  */
private[skein] final case class SensorFormulas(model: SensorModel):

  /** The detection in an image, if the opponent is detected whenever it is in view.
    *
    * @param bearing a standard normal sample, like `range`; see [[SensorModel.seen]]
    */
  def detected(
      axisRad: Double,
      ownNed: Vector3,
      opponentNed: Vector3,
      bearing: Double,
      range: Double
  ): Detected =
    val (place, covariance) = model.seen(axisRad, ownNed, opponentNed, bearing, range)
    Detected(if model.isInView(axisRad, ownNed, opponentNed) then 1 else 0, place, covariance)

  /** The estimate after an image, which must not have been taken before earlier ones. */
  def joined(before: Believed, image: Detected, validS: Double): Believed =
    val belief =
      Belief(
        Instant.Epoch,
        before.positionNed,
        before.velocityNed,
        before.position,
        before.cross,
        before.velocity
      )
    val carried = belief.carriedBy(validS - before.atS, model.fusion.acceleration)
    val after   =
      if before.isKnown > 0 then carried.joinedPosition(image.positionNed, image.covariance)
      else
        Belief.first(
          Instant.Epoch,
          image.positionNed,
          image.covariance,
          model.fusion.topSpeed.value
        )
    if image.isFound > 0 then
      Believed(
        1,
        validS,
        after.positionNed,
        after.velocityNed,
        after.position,
        after.cross,
        after.velocity
      )
    else before

  /** The inputs of a decision, and the camera's direction after it.
    *
    * @param startNed start of the opponent
    * @param aheadS time until the command takes effect, if the vehicle's own position is predicted for that
    *   moment; else −1
    */
  def decidedUpon(
      known: Believed,
      startNed: Vector3,
      ownNed: Vector3,
      nowS: Double,
      aheadS: Double
  ): DecidedUpon =
    val ageS     = if known.isKnown > 0 then nowS - known.atS else nowS
    val carriedS = if aheadS < 0 || known.isKnown <= 0 then 0.0 else CameraPursuer.carriedS(ageS + aheadS)
    val place    = if known.isKnown > 0 then known.positionNed else startNed
    val velocity = if known.isKnown > 0 then known.velocityNed else Vector3.Zero
    val way      = place + velocity * carriedS - ownNed
    val heading  = StrictMath.atan2(velocity.y, velocity.x)
    DecidedUpon(
      way.x,
      way.y,
      velocity.x,
      velocity.y,
      StrictMath.cos(heading),
      StrictMath.sin(heading),
      ageS,
      StrictMath.atan2(way.y, way.x)
    )

private[skein] object SensorFormulas:
  /** A detection in an image.
    *
    * @param isFound 1 if the opponent was detected, else 0
    */
  final case class Detected(isFound: Double, positionNed: Vector3, covariance: Matrix3)

  /** A [[Belief]], if there is one.
    *
    * @param isKnown 1 if there is an estimate, else 0
    */
  final case class Believed(
      isKnown: Double,
      atS: Double,
      positionNed: Vector3,
      velocityNed: Vector3,
      position: Matrix3,
      cross: Matrix3,
      velocity: Matrix3
  )

  /** The opponent's relative position, m, its velocity, m/s, and its heading, rad; the age of the estimate,
    * s; and the opponent's bearing, rad.
    */
  final case class DecidedUpon(
      northM: Double,
      eastM: Double,
      northMps: Double,
      eastMps: Double,
      cos: Double,
      sin: Double,
      ageS: Double,
      axisRad: Double
  )
