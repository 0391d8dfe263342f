package skein.autopilot

import scala.collection.mutable
import skein.mavlink.*
import skein.units.*

/** The messages of some vehicles to one peer, sent at intervals, encoded and cut into datagrams. Not
  * thread-safe.
  *
  * @param systems the vehicles that it sees
  * @param isDatagrams whether the peer sends datagrams, each of which ends its frames, and not pieces of a
  *   stream
  * @param mostBytes maximum size of a datagram
  */
final class MavlinkChannel(
    val systems: Vector[Int],
    from: Span,
    isDatagrams: Boolean = false,
    mostBytes: Int = 1400
):
  private val writers = systems.map(system => system -> FrameWriter(system, CommonDialect.Autopilot1)).toMap
  private val every   = mutable.HashMap.empty[(Int, Int), Span]
  private val due     = mutable.HashMap.empty[(Int, Int), Span]
  private val pieces  = Vector.newBuilder[Array[Byte]]
  private var piece   = Array.emptyByteArray
  private var waiting = 0

  /** Whether more datagrams wait than a peer could take: messages it requests now need not be encoded. */
  def isFull: Boolean = waiting >= MavlinkChannel.MostWaiting

  for system <- systems; (id, interval) <- Telemetry.intervals do
    every((system, id)) = interval
    due((system, id)) = from

  private val reader = FrameReader()

  def read(bytes: Array[Byte]): Vector[Frame] =
    if isDatagrams then reader.readDatagram(bytes) else reader.read(bytes)

  /** Frames from the peer with a wrong checksum, an unknown message or invalid content. */
  def damaged: Long = reader.counts.damaged

  /** Changes the interval of a message.
    *
    * @param micros −1 never, 0 as usual
    */
  def setInterval(system: Int, id: Int, micros: Double, now: Span): Unit =
    if micros < 0 then
      val _ = due.remove((system, id))
    else
      val asked = if micros == 0 then Telemetry.intervals(id) else Span.ofSeconds(micros.min(1e9) * 1e-6)
      every((system, id)) = asked.max(Telemetry.Shortest)
      due((system, id)) = now

  /** The earliest time at which a message is due. */
  def nextDue: Option[Span] = due.valuesIterator.minOption

  /** Takes the messages that are due, as vehicle and message number; each is due again one interval later. */
  def takeDue(now: Span): Vector[(system: Int, id: Int)] =
    val ready = due.iterator.collect { case (key, at) if at <= now => key }.toVector.sorted
    for key <- ready do
      val next = due(key) + every(key)
      // Missed messages are not sent later.
      due(key) = if next > now then next else now + every(key)
    ready.map((system, id) => (system = system, id = id))

  def write(system: Int, message: Message): Unit =
    for writer <- writers.get(system) do
      val frame = writer.write(message)
      if piece.length + frame.length > mostBytes then cut()
      piece = piece ++ frame

  /** Takes the datagrams written since the last call. */
  def take(): Vector[Array[Byte]] =
    cut()
    val all = pieces.result()
    pieces.clear()
    waiting = 0
    all

  private def cut(): Unit =
    if piece.nonEmpty then
      pieces += piece
      waiting += 1
    piece = Array.emptyByteArray

object MavlinkChannel:
  /** Maximum number of datagrams that wait; they take some 10 ms to encode. */
  private val MostWaiting = 64
