package skein.lanes.timetable

import skein.forward.{Asking, RolloutWorld, ImageTiming, LoopObserver, TabledDelays}
import skein.fusion.SensorModel

/** The events of one world's images, in order. They do not depend on decisions, so the scalar engine's own
  * timing computes them ahead. Mutable.
  */
private[lanes] final class ImageSource private (
    model: SensorModel,
    agent: Int,
    world: RolloutWorld,
    link: StandingStill.Link
) extends ImageTiming(world, agent, model, link):
  private var isTold = false

  /** Kind of the present event: an image is taken, or its result becomes known. */
  var isTaken = false

  var image = 0
  var atNs  = 0L

  /** For an image that is taken: whether an opponent in view is found, and the errors of bearing and range,
    * as [[skein.fusion.SensorFormulas.detected]] takes them.
    */
  var isFound        = false
  var bearing, range = 0f

  /** For a result that becomes known: the order in which images were taken. */
  val order: ImageOrder = ImageOrder()

  /** Begins an episode; its first event becomes the present one. */
  def begin(worldKey: Int, worldLink: TabledDelays): Unit =
    link.delays = worldLink
    world.start(worldKey, LoopObserver.Nobody)
    order.start()
    start(worldKey)
    next()

  /** Moves to the next event, if there is one. */
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
  /** Makes the source for one vehicle.
    *
    * @param agent the vehicle with the camera, in a duel
    */
  def apply(model: SensorModel, agent: Int, durationS: Double): ImageSource =
    val link  = StandingStill.Link()
    val world = RolloutWorld(
      StandingStill.engagement(2, durationS),
      link,
      Vector.fill(2)(StandingStill.Response()),
      Asking(),
      keepsAll = false,
      asksPolicies = false,
      standsStill = false,
      // No vehicle is read.
      ring = 1
    )
    new ImageSource(model, agent, world, link)
