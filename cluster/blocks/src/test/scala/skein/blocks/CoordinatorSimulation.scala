package skein.blocks

import java.nio.ByteBuffer
import java.nio.channels.FileChannel
import java.nio.file.{Files, Path, StandardOpenOption}
import java.util.PriorityQueue
import scala.collection.immutable.ArraySeq
import scala.collection.mutable
import skein.signal.SplitMix64

/** Coordinator, ledger and workers over a network that loses, doubles, delays and reorders, on a simulated
  * clock. The ledger is a file; a coordinator that dies loses an unsaved part of it.
  *
  * @param folder folder of the ledger
  * @param meanSeconds mean duration of a block, at a speed of 1
  */
final class CoordinatorSimulation(
    seed: Long,
    workers: Int,
    blocks: Int,
    folder: Path,
    meanSeconds: Double = 5.0
) extends AutoCloseable:
  import CoordinatorSimulation.*

  val file: Path            = folder.resolve(Ledger.Name)
  private val patienceNanos = (60 * meanSeconds * Second).toLong
  private val random        = SplitMix64(seed)
  private val events        = PriorityQueue[Event]()
  private var now           = 0L
  private var serial        = 0L
  private var state         = Coordinator(patienceNanos = patienceNanos, slowNanos = Second)
  private var ledger        = open()
  private var savedTo       = Files.size(file)
  private var run           = 0
  private val keys          = Vector.tabulate(blocks)(number => BlockKey.of(work(number)))

  /** Answers that the coordinator received in this run, by block. */
  private var answers = mutable.HashMap.empty[BlockKey, ArraySeq[Byte]]

  var acceptedTwice              = 0
  var messages                   = 0L
  var messageBytes               = 0L
  var usefulNanos                = 0L
  var computedNanos              = 0L
  var decidingNanos              = 0L
  var savingNanos                = 0L
  var deaths                     = 0
  var cuts                       = 0
  var restarts                   = 0
  def counts: Coordinator.Counts = state.counts
  def seconds: Double            = now * 1e-9
  def done: Int                  = answers.size
  def isDone: Boolean            = done == blocks

  /** The combined result of all blocks, in order. */
  def result: Result = resultOf(keys.iterator.map(key => valueOf(ledger.answer(key).get)))

  def close(): Unit = ledger.close()

  private def open() =
    Ledger.open(file, Question).fold(reason => throw IllegalStateException(reason), identity)

  /** Runs a coordinator's step and measures its duration. */
  private def deciding[A](body: => A): A =
    val begun = System.nanoTime()
    try body
    finally decidingNanos += System.nanoTime() - begun

  private def at(time: Long)(act: => Unit): Unit =
    serial += 1
    events.add(Event(time, serial, () => act)): Unit

  private def exponential(meanS: Double): Long = (random.nextExponential(meanS) * Second).toLong

  /** Sends a message between a worker and the coordinator: late, sometimes twice, sometimes never. */
  private def send(worker: Worker, bytes: Int)(arrives: => Unit): Unit =
    messages += 1
    messageBytes += bytes
    def once() = at(now + exponential(0.02))(if worker.cutUntil <= now then arrives)
    if random.nextDouble() > 0.02 then once()
    if random.nextDouble() < 0.02 then once()

  private final class Worker(val name: String, speed: Double):
    private var isAlive = true
    private var held    = Vector.empty[Block]
    private var begunAt = -1L
    var cutUntil        = 0L

    /** Runs one worker's process, which may end at any time. */
    def live(deathsAnHour: Double, cutsAnHour: Double): Unit =
      at(now + (random.nextDouble() * Second).toLong)(beat())
      if deathsAnHour > 0 then at(now + exponential(3600 / deathsAnHour))(die(deathsAnHour, cutsAnHour))
      if cutsAnHour > 0 then at(now + exponential(3600 / cutsAnHour))(isolated(cutsAnHour))

    private def die(deathsAnHour: Double, cutsAnHour: Double): Unit =
      deaths += 1
      isAlive = false
      if begunAt >= 0 then computedNanos += now - begunAt
      at(now + NoticedAfter) { state = deciding(state.lost(name)) }
      all -= this
      spawn(deathsAnHour, cutsAnHour)

    private def isolated(cutsAnHour: Double): Unit = if isAlive then
      cut(now + exponential(30))
      at(now + exponential(3600 / cutsAnHour))(isolated(cutsAnHour))

    /** Cuts the worker off: no message reaches or leaves it. */
    def cut(until: Long): Unit =
      cuts += 1
      cutUntil = cutUntil.max(until)
      at(now + NoticedAfter)(if isAlive && cutUntil > now then state = deciding(state.lost(name)))

    private def beat(): Unit = if isAlive then
      ask()
      at(now + Beat)(beat())

    private def ask(): Unit =
      val holding = held.map(_.number).toSet
      val toRun   = run
      send(this, AskBytes + 8 * holding.size)(if toRun == run then asked(holding))

    private def asked(holding: Set[Long]): Unit =
      val toRun                           = run
      def serve(holding: Set[Long]): Unit =
        val (next, block) = deciding(state.asked(name, holding, now))
        state = next
        block.foreach: one =>
          send(this, GiveBytes + one.work.length)(if toRun == run then take(one))
          serve(holding + one.number)
      state = deciding(state.joined(name, 1))
      serve(holding)

    private def take(block: Block): Unit =
      if isAlive && !held.exists(_.number == block.number) then
        held :+= block
        compute()

    private def compute(): Unit = if begunAt < 0 && held.nonEmpty then
      val block = held.head
      val toRun = run
      begunAt = now
      at(now + (exponential(meanSeconds) / speed).toLong):
        if isAlive then
          val took = now - begunAt
          begunAt = -1
          computedNanos += took
          held = held.filterNot(_.number == block.number)
          val answer = CoordinatorSimulation.answer(block.work)
          send(this, DoneBytes + answer.length)(
            if toRun == run then answered(name, block.number, answer, took)
          )
          ask()
          compute()

  private def answered(worker: String, number: Long, answer: ArraySeq[Byte], took: Long): Unit =
    deciding:
      val (next, first) = state.answered(worker, number, took)
      state = next
      first.foreach: block =>
        if !ledger.accept(block.key, answer) then acceptedTwice += 1
        answers.update(block.key, answer)
        usefulNanos += took

  private val all                                                   = mutable.LinkedHashSet.empty[Worker]
  private var born                                                  = 0
  private def spawn(deathsAnHour: Double, cutsAnHour: Double): Unit =
    born += 1
    val speed  = 0.2 / math.pow(1 - random.nextDouble(), 1 / 1.5) // heavy-tailed
    val worker = Worker(s"worker-$born", speed)
    all += worker
    worker.live(deathsAnHour, cutsAnHour)

  /** The coordinator dies and restarts: it loses everything except the ledger, and of the ledger's unsaved
    * end all or a part.
    */
  private def restart(): Unit =
    restarts += 1
    run += 1
    ledger.close()
    if Files.exists(file) then
      val kept = savedTo + (random.nextDouble() * (Files.size(file) - savedTo + 1)).toLong
      val _    = scala.util.Using.resource(FileChannel.open(file, StandardOpenOption.WRITE))(_.truncate(kept))
    ledger = open()
    begin()

  private def begin(): Unit =
    answers = mutable.HashMap.from(keys.flatMap(key => ledger.answer(key).map(key -> _)))
    state = deciding:
      Coordinator(patienceNanos = patienceNanos, slowNanos = Second).offered(
        keys.indices
          .filterNot(number => answers.contains(keys(number)))
          .map(number => Block(run * 10_000_000L + number, work(number)))
      )

  /** Runs until all is done.
    *
    * @param deathsAnHour fraction of the workers that die in an hour; each is noticed after 10 s, and another
    *   starts
    * @param cutsAnHour number of times that a worker is cut off in an hour, for 30 s on average
    * @param splits times, s, at which a fifth of all workers is cut off simultaneously, for two minutes
    * @param restarts times of the coordinator's restarts, s
    * @param saving whether the ledger is flushed to the disk once a second
    * @param onTick called once a second
    */
  def fly(
      deathsAnHour: Double,
      cutsAnHour: Double,
      restarts: Seq[Double] = Nil,
      splits: Seq[Double] = Nil,
      saving: Boolean = false
  )(onTick: => Unit = ()): Unit =
    for _ <- 0 until workers do spawn(deathsAnHour, cutsAnHour)
    begin()
    restarts.foreach(when => at((when * Second).toLong)(restart()))
    for when <- splits do
      at((when * Second).toLong):
        all.iterator.filter(_ => random.nextDouble() < 0.2).toVector.foreach(_.cut(now + 120 * Beat))
    def tick(): Unit =
      state = deciding(state.at(now))
      if saving then
        val begun = System.nanoTime()
        ledger.force()
        savingNanos += System.nanoTime() - begun
      savedTo = Files.size(file)
      onTick
      at(now + Beat)(tick())
    tick()
    while !isDone && !events.isEmpty do
      val event = events.poll()
      now = event.at
      event.act()

object CoordinatorSimulation:
  private val Second       = 1e9.toLong
  private val Beat         = Second
  private val NoticedAfter = 10 * Second
  private val Question     = ArraySeq.from(Array.fill[Byte](32)(7))

  /** Bytes of skein-cluster's messages, without their content. */
  private val AskBytes, GiveBytes, DoneBytes = 130

  private final class Event(val at: Long, serial: Long, val act: () => Unit) extends Comparable[Event]:
    private def place                = serial
    def compareTo(other: Event): Int =
      if at != other.at then java.lang.Long.compare(at, other.at)
      else java.lang.Long.compare(place, other.place)

  /** The result of a search: the best block, its value, and the sum of all in the blocks' order. */
  final case class Result(best: Int, value: Double, sum: Double)

  def bytes(text: String): ArraySeq[Byte] = ArraySeq.unsafeWrapArray(text.getBytes("UTF-8"))

  /** A block's work, as long as a candidate of 16 parameters. */
  def work(number: Int): ArraySeq[Byte] =
    ArraySeq.unsafeWrapArray(ByteBuffer.allocate(128).putInt(number).array)

  /** A block's answer, as long as three candidates' statistics; it depends only on the work. */
  def answer(work: ArraySeq[Byte]): ArraySeq[Byte] =
    val number = ByteBuffer.wrap(work.toArray).getInt
    ArraySeq.unsafeWrapArray(ByteBuffer.allocate(60).putDouble(SplitMix64(number).nextDouble()).array)

  private def valueOf(answer: ArraySeq[Byte]): Double = ByteBuffer.wrap(answer.toArray).getDouble

  private def resultOf(values: Iterator[Double]): Result =
    values.zipWithIndex.foldLeft(Result(-1, -1, 0)):
      case (Result(best, most, sum), (value, index)) =>
        if value > most then Result(index, value, sum + value) else Result(best, most, sum + value)

  /** The result of one process that computes block after block. */
  def alone(blocks: Int): Result =
    resultOf(Iterator.range(0, blocks).map(number => valueOf(answer(work(number)))))
