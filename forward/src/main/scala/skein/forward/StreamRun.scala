package skein.forward

/** [[LoopTiming.Stream]]. */
private[skein] final class StreamRun(timing: LoopTiming.Stream, world: DuelWorld)
    extends AskingRun(world, timing.periodS, timing.asking):

  private val patienceNs             = Nanos.of(timing.patienceS)
  val controllers: Array[Controller] =
    val interval = Nanos.of(timing.periodS) - Nanos.of(timing.toleranceS)
    Array.tabulate(world.count)(Controller(world, _, timing.steering, interval, timing.decideThenPace, this))

  // What is joined, as skein.flow.JoinLatest keeps it.
  private val observation  = DuelObservation(world.count)
  private val waiting      = Array.ofDim[Boolean](world.count)
  private var patienceEnds = StreamRun.NoEnd

  override def start(): Unit =
    java.util.Arrays.fill(waiting, true)
    patienceEnds = StreamRun.NoEnd
    super.start()

  protected def renewed(vehicle: Int, question: Int): Unit =
    waiting(vehicle) = false
    observation.take(world, vehicle, question)
    if !known.contains(false) then
      if !waiting.contains(true) || patienceNs <= 0 then join()
      else if patienceEnds == StreamRun.NoEnd then
        patienceEnds = world.nowNs + patienceNs
        world.schedule(patienceEnds, DuelWorld.Patience, 0, 0)

  override def patienceOver(): Unit = if patienceEnds == world.nowNs then join()

  private def join(): Unit =
    java.util.Arrays.fill(waiting, true)
    patienceEnds = StreamRun.NoEnd
    observation.takeSent(controllers)
    for controller <- controllers do controller.offer(observation)

private[skein] object StreamRun:
  private val NoEnd = -1L
