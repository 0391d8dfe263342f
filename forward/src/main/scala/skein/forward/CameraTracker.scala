package skein.forward

import skein.fusion.{Exposure, Fusion, Measurement, SensorModel}
import skein.policy.CameraPursuer
import skein.simd.WorldRandom
import skein.units.*

/** What a vehicle believes of its opponent by a [[SensorModel]] while it flies: images on their way, in
  * recognition, and what came of them. Mutable; allocates.
  *
  * @param opponent whom it looks for
  */
private[skein] final class CameraTracker(
    world: DuelWorld,
    agent: Int,
    opponent: Int,
    model: SensorModel,
    link: Delays
) extends OpponentView:
  import CameraTracker.*

  private val periodNs   = Nanos.of(model.everyS)
  private val deadlineNs = Nanos.of(model.deadlineS)
  private val images     = Array.ofDim[Option[Measurement]](Ring)

  private var key                       = 0
  private var onTheWay, busy            = 0
  private var newest, waiting, reported = -1
  private var fusion                    = Fusion(model.fusion)
  private var axisRad                   = 0.0

  def start(worldKey: Int): Unit =
    key = WorldRandom.key(worldKey, Stream, agent)
    onTheWay = 0; busy = 0; newest = -1; waiting = -1; reported = -1
    fusion = Fusion(model.fusion)
    axisRad = StrictMath.atan2(startNed.y - place(agent).y, startNed.x - place(agent).x)
    if !world.standsStill then world.schedule(0, DuelWorld.Look, agent, 0)

  /** An image is due. */
  def look(number: Int): Unit =
    world.schedule((number + 1) * periodNs, DuelWorld.Look, agent, number + 1)
    if onTheWay < MostOnTheWay then
      onTheWay += 1
      val delay = link.delayNs(key, Delays.question(0, agent), number, number, world.nowNs)
      world.schedule(world.nowNs + delay, DuelWorld.Exposed, agent, number)

  def exposed(number: Int): Unit =
    images(number % Ring) = measured(number)
    val delay = link.delayNs(key, Delays.answer(0, agent), number, number, world.nowNs)
    world.schedule(world.nowNs + delay, DuelWorld.ImageReceived, agent, number)

  /** An image has come: the newest waits for whoever recognises. */
  def imageReceived(number: Int): Unit =
    onTheWay -= 1
    if number > newest then
      newest = number
      if busy < model.workers then recognise(number) else waiting = number

  private def recognise(number: Int): Unit =
    busy += 1
    world.schedule(world.nowNs + takesNs(number), DuelWorld.Recognised, agent, number)

  def recognised(number: Int): Unit =
    busy -= 1
    if number > reported && takesNs(number) <= deadlineNs then
      reported = number
      world.observer.recognised(agent, number, world.nowNs)
      images(number % Ring).foreach(join)
    if waiting >= 0 then
      recognise(waiting)
      waiting = -1

  private def join(measured: Measurement): Unit = for joined <- fusion.including(measured) do fusion = joined

  private def measured(number: Int): Option[Measurement] =
    val taken =
      Exposure(axisRad, place(agent), place(opponent), even(number, 0), even(number, 1), even(number, 2))
    world.observer.exposed(agent, number, world.nowNs, taken)
    model.measured(Instant.ofNanos(world.nowNs), taken)

  /** While the world stands still, an image is waited for. */
  def believed(aheadS: Option[Double]): (placeNed: Vector3, velocityNed: Vector3, ageS: Double) =
    if world.standsStill then
      newest += 1
      val image = measured(newest)
      world.observer.recognised(agent, newest, world.nowNs)
      image.foreach(join)
    fusion.belief.fold((startNed, Vector3.Zero, world.nowS)): belief =>
      val ageS = (world.nowNs - belief.at.toNanos) * 1e-9
      (
        CameraPursuer.carried(belief.positionNed, belief.velocityNed, aheadS.map(ageS + _)),
        belief.velocityNed,
        ageS
      )

  def turn(northM: Double, eastM: Double): Unit = axisRad = StrictMath.atan2(eastM, northM)

  private def takesNs(number: Int) = model.takes.quantile(even(number, 3)).toNanos

  private def startNed =
    val there = world.agents(opponent)
    Vector3(there.startX, there.startY, there.altitudeDownM)

  private def place(vehicle: Int): Vector3 =
    val body = world.vehicles(vehicle)
    body.advance(world.nowS)
    Vector3(body.x, body.y, world.agents(vehicle).altitudeDownM)

  private def even(number: Int, place: Int): Double =
    (WorldRandom.bits(key, number * Delays.Lines + Delays.FirstCommand + place) >>> 8) * Step

private[skein] object CameraTracker:
  /** Images of which anything is remembered. */
  private[skein] val Ring = 64

  /** As `skein.flight.CameraSensor` has them. */
  private val MostOnTheWay = 2

  /** Apart from the sequence of all other delays. */
  private val Stream = 0x65796573L

  private val Step = 1.0 / (1 << 24)
