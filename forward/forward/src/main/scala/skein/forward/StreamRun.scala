package skein.forward

/** The loop [[LoopTiming.Stream]] in virtual time: decisions follow joined readings. */
private[skein] final class StreamRun(timing: LoopTiming.Stream, world: RolloutWorld)
    extends JoiningRun(timing, world):

  val controllers: Array[Controller] =
    val interval = Nanos.of(timing.periodS) - Nanos.of(timing.toleranceS)
    Array.tabulate(world.count)(Controller(world, _, timing.steering, interval, timing.decideThenPace, this))

  protected def joined(): Unit =
    observation.takeSent(controllers)
    for controller <- controllers do controller.offer(observation)
