package skein.ros

import java.lang.foreign.ValueLayout.{ADDRESS, JAVA_BYTE, JAVA_INT, JAVA_LONG}
import java.lang.foreign.{Arena, MemorySegment}
import java.util.concurrent.atomic.{AtomicLong, AtomicReference}
import scala.util.control.NonFatal
import skein.ros.message.{Cdr, MessageType}
import skein.units.{Clock, Instant, Span}

/** A node of ROS 2: it publishes topics and subscribes to them, as serialized messages. Domain, middleware
  * and security are those of the environment, as for every node (`ROS_DOMAIN_ID`, `RMW_IMPLEMENTATION`).
  *
  * Messages are received on a thread of its own, in their order. All memory that the node takes outside the
  * Java heap is freed when it is closed.
  */
final class RosNode private (
    library: RosLibrary,
    arena: Arena,
    context: MemorySegment,
    node: MemorySegment,
    clock: Clock
) extends RosGraph:
  import RosNode.*

  private val allocator          = library.allocator(arena)
  private val publishers         = AtomicReference(Vector.empty[RosPublisher[?]])
  private val readers            = AtomicReference(Vector.empty[Reader])
  private val failures           = AtomicLong()
  private val malformed          = AtomicLong()
  private val noted              = AtomicReference(Vector.empty[String])
  @volatile private var isClosed = false
  @volatile private var watcher  = Option.empty[RosWatcher]

  /** Messages that the middleware did not take. */
  def failed: Long = failures.get

  def refused: Long = malformed.get

  def lost: Long = readers.get.map(_.lost.count).sum

  def notes: Vector[String] = noted.get

  private def note(line: String): Unit =
    val _ =
      noted.updateAndGet(all => if all.contains(line) || all.size >= MostNotes then all else all :+ line)

  /** Publishes a topic.
    *
    * @param topic its name, such as `/drone_1/odom`
    * @return Left if the message's package is not installed, or ROS 2 rejects the topic, with the reason
    */
  def publish[A](topic: String, qos: Qos = Qos.Reliable)(using
      kind: MessageType[A]
  ): Either[String, RosPublisher[A]] =
    opened(topic, kind.toString): support =>
      val publisher = arena.allocate(PointerRoom, 8)
      val options   = withQos(library.senderOptions(arena), qos)
      library.call(library.initSender, publisher, node, support, arena.allocateFrom(topic), options)
      val made = RosPublisher[A](library, publisher, allocator, failures)
      publishers.updateAndGet(_ :+ made): Unit
      made

  /** Subscribes to a topic.
    *
    * @param receive called for each message on the node's thread, so it must return soon
    * @return Left as for [[publish]]
    */
  def subscribe[A](topic: String, qos: Qos = Qos.BestEffort)(receive: A => Unit)(using
      kind: MessageType[A]
  ): Either[String, Unit] =
    reading(topic, kind.toString, qos, MostBytes): (message, _) =>
      Cdr.message(message)(using kind.cdr).map(receive)

  def subscribeRaw(topic: String, kind: String, qos: Qos, most: Int)(
      receive: (Array[Byte], Instant) => Unit
  ): Either[String, Unit] =
    reading(topic, kind, qos, most)((message, at) => Right(receive(message, at)))

  private def reading(topic: String, kind: String, qos: Qos, most: Long)(
      read: (Array[Byte], Instant) => Either[String, Unit]
  ): Either[String, Unit] =
    opened(topic, kind): support =>
      val subscription = arena.allocate(PointerRoom, 8)
      val options      = withQos(library.readerOptions(arena), qos)
      library.call(library.initReader, subscription, node, support, arena.allocateFrom(topic), options)
      val bytes = arena.allocate(24 + RosLibrary.AllocatorLayout.byteSize, 8)
      library.call(library.initBytes, bytes, FirstBytes, allocator)
      readers.updateAndGet(_ :+ Reader(topic, kind, subscription, bytes, most, read)): Unit

  def definition(kind: String): String = library.definition(kind)

  /** Lets `watching` see the graph from now on. */
  def watch(watching: RosWatcher): Unit = watcher = Some(watching)

  private def opened[A](topic: String, kind: String)(open: MemorySegment => A): Either[String, A] =
    library.typeSupport(kind).flatMap: support =>
      synchronized:
        if isClosed then Left(s"$topic: the node is closed")
        else
          try Right(open(support))
          catch case failure: RosFailure => Left(s"$topic: ${failure.getMessage}")

  private val thread = Thread.ofPlatform().daemon().name("skein-ros").start(() => receiveAll())

  private def receiveAll(): Unit =
    val own = Arena.ofConfined()
    try
      var waitSet = own.allocate(WaitSetRoom, 8)
      var awaits  = 0
      var lookAt  = clock.now() + LookEvery
      val taken   = own.allocate(InfoRoom, 8)
      val found   = own.allocate(TypesRoom, 8)
      while !isClosed do
        val all     = readers.get
        val begunAt = clock.now()
        if all.size > awaits then
          if awaits > 0 then library.call(library.endWait, waitSet)
          waitSet = own.allocate(WaitSetRoom, 8)
          library.call(
            library.initWait,
            waitSet +: all.size.toLong +: Vector.fill(5)(0L) :+ context :+ allocator*
          )
          awaits = all.size
        if awaits == 0 then Thread.sleep(Patience.toNanos / 1_000_000)
        else
          library.call(library.clearWait, waitSet)
          for one <- all do library.call(library.addToWait, waitSet, one.subscription, MemorySegment.NULL)
          library.status(library.await, waitSet, Patience.toNanos) match
            case RosLibrary.Ok       => all.foreach(takeFrom(_, taken))
            case RosLibrary.TimedOut => ()
            case other               => throw RosFailure(s"rcl_wait: ${library.reason(other)}")
          watcher.foreach(_.upTo(begunAt))
        if clock.now() >= lookAt then
          lookAt = clock.now() + LookEvery
          val topics = topicsAndTypes(found)
          noteOtherTypes(all, topics)
          watcher.foreach(_.topics(topics))
      if awaits > 0 then library.call(library.endWait, waitSet)
    catch case failure: RosFailure => note(s"nothing is received any more: ${failure.getMessage}")
    finally own.close()

  private def takeFrom(one: Reader, info: MemorySegment): Unit =
    var left = MostAtOnce
    while left > 0 do
      left -= 1
      library.status(library.take, one.subscription, one.bytes, info, MemorySegment.NULL) match
        case RosLibrary.Ok =>
          one.lost.add(
            (info.get(JAVA_LONG, PublisherAt), info.get(JAVA_LONG, PublisherAt + 8)),
            info.get(JAVA_LONG, NumberAt)
          )
          val length = one.bytes.get(JAVA_LONG, 8)
          if length > MostBytes then refuse(one.topic, s"expected at most $MostBytes bytes, got $length")
          else
            val message = one.bytes.get(ADDRESS, 0).reinterpret(length.min(one.most)).toArray(JAVA_BYTE)
            try one.read(message, arrivedAt(info)).left.foreach(refuse(one.topic, _))
            catch case NonFatal(failure) => refuse(one.topic, failure.toString)
        case other =>
          left = 0
          if other != RosLibrary.NothingToTake then refuse(one.topic, library.reason(other))

  /** Counts a refused message; only the reason of a topic's first one is noted. */
  private[ros] def refuse(topic: String, why: String): Unit =
    val begin = s"$topic: refused a message: "
    if !noted.get.exists(_.startsWith(begin)) then note(begin + why)
    malformed.incrementAndGet(): Unit

  /** The time at which a message was received, by the middleware, or else the present time. */
  private def arrivedAt(info: MemorySegment): Instant =
    val now      = clock.now()
    val received = Instant.ofNanos(info.get(JAVA_LONG, ReceivedAt))
    if now.since(received) < MostApart && received.since(now) < MostApart then received else now

  /** All topics of the graph, with the types by which nodes use them. */
  private def topicsAndTypes(found: MemorySegment): Vector[(String, Vector[String])] =
    found.fill(0): Unit
    if library.status(library.topicTypes, node, allocator, false, found) != RosLibrary.Ok then Vector.empty
    else
      val names  = texts(found)
      val types  = found.get(ADDRESS, StringsRoom).reinterpret(names.size * StringsRoom)
      val topics = names.zipWithIndex.map((name, index) =>
        name -> texts(types.asSlice(index * StringsRoom, StringsRoom))
      )
      library.status(library.endTypes, found): Unit
      topics

  /** Notes this node's topics that others publish, or read, as another type: ROS 2 does not connect them and
    * reports nothing.
    */
  private def noteOtherTypes(all: Vector[Reader], topics: Vector[(String, Vector[String])]): Unit =
    val types = topics.toMap
    for reader <- all; other <- types.getOrElse(reader.topic, Vector.empty) if other != reader.kind do
      note(s"${reader.topic}: expected ${reader.kind}, a node uses $other, which is not received")

  /** Reads an `rcutils_string_array_t`, which is a number of texts and their address. */
  private def texts(array: MemorySegment): Vector[String] =
    val count = array.get(JAVA_LONG, 0)
    if count == 0 then Vector.empty
    else
      val data = array.get(ADDRESS, 8).reinterpret(count * 8)
      Vector.tabulate(count.toInt)(index =>
        data.getAtIndex(ADDRESS, index).reinterpret(MostChars).getString(0)
      )

  /** Ends the node; returns once no message is being received any more. */
  def close(): Unit =
    val isFirst = synchronized:
      val first = !isClosed
      isClosed = true
      first
    if isFirst then
      thread.join(JoinMillis)
      // Memory that a receiver may still use is kept.
      if !thread.isAlive then
        try
          publishers.get.foreach(_.close(node))
          for one <- readers.get do
            library.call(library.endBytes, one.bytes)
            library.call(library.endReader, one.subscription, node)
          library.call(library.endNode, node)
          library.call(library.shutdown, context)
          library.call(library.endContext, context)
        finally arena.close()

object RosNode:
  private final class Reader(
      val topic: String,
      val kind: String,
      val subscription: MemorySegment,
      val bytes: MemorySegment,
      val most: Long,
      val read: (Array[Byte], Instant) => Either[String, Unit]
  ):
    val lost = LostMessages()

  /** Bytes for a struct of one or a few pointers. */
  private val PointerRoom = 64L

  /** Bytes for `rcl_wait_set_t`: six arrays with their sizes, and a pointer; some reserve. */
  private val WaitSetRoom = 256L

  /** Size of the memory for `rmw_message_info_t`, with reserve, and the offsets in it of the time of
    * reception, the message's number and the publisher's identifier. In Foxy the latter two read constants.
    */
  private val InfoRoom    = 512L
  private val ReceivedAt  = 8L
  private val NumberAt    = 16L
  private val PublisherAt = 40L

  /** Greatest accepted difference between the middleware's clock and this process's clock; some middleware
    * states no time.
    */
  private val MostApart = Span.ofSeconds(10)

  /** Bytes of `rcutils_string_array_t`: size, address, allocator. */
  private val StringsRoom = 16 + RosLibrary.AllocatorLayout.byteSize

  /** Bytes for `rcl_names_and_types_t`: the names, and the address of the types; some reserve. */
  private val TypesRoom = 128L

  private val FirstBytes = 4096L
  private val MostBytes  = 64L << 20
  private val MostChars  = 4096L
  private val MostNotes  = 16

  /** Maximum number of one topic's messages that are received before another topic's turn. */
  private val MostAtOnce = 64

  private val Patience   = Span.ofMillis(100)
  private val LookEvery  = Span.ofMillis(500)
  private val JoinMillis = 2_000L

  /** The reason why no node can be opened here: ROS 2 is not installed, or not in the environment. None if
    * one can be opened.
    */
  def missing: Option[String] = RosLibrary.here.left.toOption

  /** Opens a node.
    *
    * @param name letters, digits and `_`
    * @param remappings other names for topics, such as `/a/odom:=/uav1/odometry`
    * @return Left if ROS 2 is not installed, or rejects the node, with the reason
    */
  def open(name: String, clock: Clock, remappings: Seq[String] = Nil): Either[String, RosNode] =
    RosLibrary.here.flatMap: library =>
      val arena = Arena.ofShared()
      try
        val (options, context, node) =
          (arena.allocate(PointerRoom, 8), arena.allocate(PointerRoom, 8), arena.allocate(PointerRoom, 8))
        library.call(library.initOptions, options, library.allocator(arena))
        val words = if remappings.isEmpty then Nil else "--ros-args" +: remappings.flatMap(Seq("-r", _))
        val argv  = if words.isEmpty then MemorySegment.NULL else arena.allocate(8L * words.size, 8)
        for (word, index) <- words.zipWithIndex do argv.setAtIndex(ADDRESS, index, arena.allocateFrom(word))
        library.call(library.init, words.size, argv, options, context)
        library.call(library.endOptions, options)
        library.call(
          library.initNode,
          node,
          arena.allocateFrom(name),
          arena.allocateFrom(""),
          context,
          library.nodeOptions(arena)
        )
        Right(RosNode(library, arena, context, node, clock))
      catch
        case failure: RosFailure =>
          arena.close()
          Left(s"ROS 2: ${failure.getMessage}")

  /** Writes a quality of service at the beginning of options, where `rmw_qos_profile_t` stands: history,
    * depth, reliability and durability; the rest keeps its defaults.
    */
  private def withQos(options: MemorySegment, qos: Qos): MemorySegment =
    options.set(JAVA_INT, 0, KeepLast)
    options.set(JAVA_LONG, 8, qos.depth.toLong)
    options.set(JAVA_INT, 16, if qos.isReliable then ReliableKind else BestEffortKind)
    options.set(JAVA_INT, 20, VolatileKind)
    options

  private val KeepLast       = 1
  private val ReliableKind   = 1
  private val BestEffortKind = 2
  private val VolatileKind   = 2
