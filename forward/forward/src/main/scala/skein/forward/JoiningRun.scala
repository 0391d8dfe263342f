package skein.forward

/** Joins the newest readings into views, like `skein.flow.JoinLatest`, under [[LoopTiming.Stream]]. Mutable.
  */
private[skein] abstract class JoiningRun(timing: LoopTiming.Stream, world: RolloutWorld)
    extends AskingRun(world, timing.periodS, timing.asking):
  import JoiningRun.NoEnd

  private val patienceNs = Nanos.of(timing.patienceS)

  protected val observation: RolloutView = RolloutView(world)

  /** For each vehicle, whether no newer reading has arrived since the last view. */
  protected val waiting: Array[Boolean] = Array.ofDim(world.count)

  private var patienceEnds = NoEnd

  override protected def begin(question: Int): Unit =
    java.util.Arrays.fill(waiting, true)
    patienceEnds = NoEnd
    super.begin(question)

  protected def renewed(vehicle: Int, question: Int): Unit =
    waiting(vehicle) = false
    observation.take(vehicle, question)
    if !known.contains(false) then
      if !waiting.contains(true) || patienceNs <= 0 then join()
      else if patienceEnds == NoEnd then
        patienceEnds = world.nowNs + patienceNs
        world.schedule(patienceEnds, RolloutWorld.Patience, 0, 0)

  override def patienceOver(): Unit = if patienceEnds == world.nowNs then join()

  private def join(): Unit =
    joined()
    java.util.Arrays.fill(waiting, true)
    patienceEnds = NoEnd

  protected def joined(): Unit

private[skein] object JoiningRun:
  private val NoEnd = -1L
