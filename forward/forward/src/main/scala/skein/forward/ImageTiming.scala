package skein.forward

import skein.fusion.SensorModel
import skein.simd.WorldRandom

/** Simulates when a vehicle's images are taken and when their results become known, as in `skein.flow.Frames`
  * and `Recognise`. These times do not depend on the vehicles' positions. Mutable.
  */
private[skein] abstract class ImageTiming(world: RolloutWorld, agent: Int, model: SensorModel, link: Delays):
  import ImageTiming.*

  private val periodNs   = Nanos.of(model.everyS)
  private val deadlineNs = Nanos.of(model.deadlineS)

  private var worldKey, key             = 0
  private var onTheWay, busy            = 0
  private var newest, waiting, reported = -1

  /** Resets to the start of an episode. Images are due from then on, unless the world waits for each image.
    */
  def start(worldKey: Int): Unit =
    this.worldKey = worldKey
    key = Delays.imageKey(worldKey, agent)
    onTheWay = 0; busy = 0; newest = -1; waiting = -1; reported = -1
    if !world.standsStill then world.schedule(0, RolloutWorld.Look, agent, 0)

  protected def taken(number: Int): Unit

  /** Called when an image's result becomes known, in the order of the images' numbers. */
  protected def known(number: Int): Unit

  /** Handles an event of an image.
    *
    * @param kind the kind of the event, a constant of [[RolloutWorld]]
    */
  final def handle(kind: Int, number: Int): Unit = kind match
    case RolloutWorld.Look          => look(number)
    case RolloutWorld.Exposed       => exposed(number)
    case RolloutWorld.ImageReceived => received(number)
    case RolloutWorld.Recognised    => recognised(number)

  private def look(number: Int): Unit =
    world.schedule((number + 1) * periodNs, RolloutWorld.Look, agent, number + 1)
    if onTheWay < MostOnTheWay then
      onTheWay += 1
      val delay = link.delayNs(worldKey, Delays.image(agent), number, number, world.nowNs)
      world.schedule(world.nowNs + delay, RolloutWorld.Exposed, agent, number)

  private def exposed(number: Int): Unit =
    taken(number)
    val delay = link.delayNs(worldKey, Delays.image(agent) + 1, number, number, world.nowNs)
    world.schedule(world.nowNs + delay, RolloutWorld.ImageReceived, agent, number)

  /** Recognises an image, or lets it wait for a free recogniser. An image that is overtaken by a newer one is
    * dropped.
    */
  private def received(number: Int): Unit =
    onTheWay -= 1
    if number > newest then
      newest = number
      if busy < model.workers then recognise(number) else waiting = number

  private def recognise(number: Int): Unit =
    busy += 1
    world.schedule(world.nowNs + takesNs(number), RolloutWorld.Recognised, agent, number)

  private def recognised(number: Int): Unit =
    busy -= 1
    if number > reported && takesNs(number) <= deadlineNs then
      reported = number
      known(number)
    if waiting >= 0 then
      recognise(waiting)
      waiting = -1

  private def takesNs(number: Int) = model.takes.quantile(even(number, Takes)).toNanos

  /** A random number of an image, uniform in [0, 1).
    *
    * @param what use of the number: [[ImageTiming.Found]] or a following constant
    */
  protected final def even(number: Int, what: Int): Double =
    WorldRandom.uniform(key, number * Delays.Lines + Delays.FirstCommand + what)

private[skein] object ImageTiming:
  /** Number of images whose results may still be used. */
  val Ring = 64

  // The random numbers of an image: for detection in view, the two errors, and the duration of recognition.
  val Found         = 0
  val Bearing       = 1
  val Range         = 2
  private val Takes = 3

  /** Maximum number of images that are being transmitted, as in `skein.flight.CameraSensor`. */
  private val MostOnTheWay = 2
