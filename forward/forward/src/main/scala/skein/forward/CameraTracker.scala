package skein.forward

import skein.fusion.{Exposure, Fusion, Measurement, SensorModel}
import skein.policy.CameraPursuer
import skein.units.*

/** A vehicle's estimate of its opponent by a [[SensorModel]] during a simulated flight: takes images and
  * evaluates them. Mutable; allocates.
  *
  * @param opponent index of the vehicle to be detected
  */
private[skein] final class CameraTracker(
    world: RolloutWorld,
    agent: Int,
    opponent: Int,
    model: SensorModel,
    link: Delays
) extends ImageTiming(world, agent, model, link), OpponentView:
  import ImageTiming.{Bearing, Found, Range, Ring}
  import OpponentView.Believed

  private val images    = Array.ofDim[Option[Measurement]](Ring)
  private var waitedFor = -1
  private var fusion    = Fusion(model.fusion)
  private var axisRad   = 0.0

  override def start(worldKey: Int): Unit =
    waitedFor = -1
    fusion = Fusion(model.fusion)
    val way = startNed(opponent) - startNed(agent)
    turn(way.x, way.y)
    super.start(worldKey)

  protected def taken(number: Int): Unit = images(number % Ring) = measured(number)

  protected def known(number: Int): Unit =
    world.observer.recognised(agent, number, world.nowNs)
    images(number % Ring).foreach(join)

  private def join(measured: Measurement): Unit = for joined <- fusion.including(measured) do fusion = joined

  private def measured(number: Int): Option[Measurement] =
    val image =
      Exposure(
        axisRad,
        place(agent),
        place(opponent),
        even(number, Found),
        even(number, Bearing),
        even(number, Range)
      )
    world.observer.exposed(agent, number, world.nowNs, image)
    model.measured(Instant.ofNanos(world.nowNs), image)

  /** The estimate; in a world that waits for the controller, the time of an image passes first. */
  def believed(aheadS: Option[Double]): Believed =
    if world.standsStill then
      waitedFor += 1
      taken(waitedFor)
      known(waitedFor)
    val now = Instant.ofNanos(world.nowNs)
    fusion.belief.fold(Believed(startNed(opponent), Vector3.Zero, Span.ofNanos(world.nowNs))): belief =>
      val age = now.since(belief.at)
      Believed(
        CameraPursuer.carried(belief.positionNed, belief.velocityNed, aheadS.map(age.toSeconds + _)),
        belief.velocityNed,
        age
      )

  def turn(northM: Double, eastM: Double): Unit = axisRad = StrictMath.atan2(eastM, northM)

  private def startNed(vehicle: Int) =
    val there = world.agents(vehicle)
    Vector3(there.startX, there.startY, there.altitudeDownM)

  private def place(vehicle: Int): Vector3 =
    val body = world.vehicles(vehicle)
    body.advance(world.nowS)
    Vector3(body.x, body.y, world.agents(vehicle).altitudeDownM)
