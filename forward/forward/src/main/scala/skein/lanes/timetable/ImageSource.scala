package skein.lanes.timetable

import skein.forward.{Asking, RolloutWorld, ImageTiming, LoopObserver, TabledDelays}
import skein.fusion.SensorModel

/** What happens to the images of one world's vehicle, one thing after the other. Nothing of it depends on
  * what is decided, so the scalar engine's own timing tells it ahead. Mutable.
  */
private[lanes] final class ImageSource private (
    model: SensorModel,
    agent: Int,
    world: RolloutWorld,
    link: StandingStill.Link
) extends ImageTiming(world, agent, model, link):
  private var isTold = false

  /** What is told: an image is taken, or what one shows is known. */
  var isTaken = false

  /** The image, and when it happens, ns. */
  var image = 0
  var atNs  = 0L

  /** Of an image that is taken, whether what is in view is found, and if so the errors of the bearing and of
    * the range, as [[skein.fusion.SensorFormulas.detected]] takes them.
    */
  var isFound        = false
  var bearing, range = 0f

  /** Of what is known, which images were taken first. */
  val order: ImageOrder = ImageOrder()

  /** Begins an episode, with what happens first. */
  def begin(worldKey: Int, worldLink: TabledDelays): Unit =
    link.delays = worldLink
    world.start(worldKey, LoopObserver.Nobody)
    order.start()
    start(worldKey)
    next()

  /** Goes on to what happens next. */
  def next(): Unit =
    isTold = false
    while !isTold do
      val event = world.next()
      handle(RolloutWorld.kindOf(event), RolloutWorld.numberOf(event))

  private def tell(number: Int, taken: Boolean): Unit =
    image = number
    atNs = world.nowNs
    isTaken = taken
    isTold = true

  protected def taken(number: Int): Unit =
    tell(number, taken = true)
    order.taken(number, world.nowNs)
    isFound = even(number, ImageTiming.Found) < model.detection
    if isFound then
      bearing = SensorModel.normal(even(number, ImageTiming.Bearing)).toFloat
      range = SensorModel.normal(even(number, ImageTiming.Range)).toFloat

  protected def known(number: Int): Unit =
    tell(number, taken = false)
    order.known(number)

private[lanes] object ImageSource:
  /** @param agent the vehicle whose images are told of, in a duel */
  def apply(model: SensorModel, agent: Int, durationS: Double): ImageSource =
    val link  = StandingStill.Link()
    val world = RolloutWorld(
      StandingStill.engagement(2, durationS),
      link,
      StandingStill.Response(),
      Asking(),
      keepsAll = false,
      standsStill = false,
      // Nobody is asked.
      ring = 1
    )
    new ImageSource(model, agent, world, link)
