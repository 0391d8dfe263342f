package skein.ros

import java.io.File
import java.lang.foreign.ValueLayout.{ADDRESS, JAVA_BOOLEAN, JAVA_INT, JAVA_LONG}
import java.lang.foreign.{
  Arena,
  FunctionDescriptor,
  Linker,
  MemoryLayout,
  MemorySegment,
  SegmentAllocator,
  StructLayout,
  SymbolLookup
}
import java.lang.invoke.MethodHandle
import java.nio.file.{Files, Path}
import scala.collection.concurrent.TrieMap
import scala.util.Try

/** ROS 2's C client library `librcl` of an installed ROS 2, called without a build and without generated
  * code. Skein contains no part of it. It stays loaded until the process ends.
  *
  * It uses only declarations that are equal in the headers of all distributions since Foxy. Structs returned
  * by value are received in larger memory than they need, so that their sizes may differ.
  */
private[ros] final class RosLibrary private (folders: Vector[Path], rcl: SymbolLookup):
  import RosLibrary.*

  private val linker = Linker.nativeLinker()

  private def handle(name: String, signature: FunctionDescriptor): MethodHandle =
    val symbol =
      rcl.find(name).orElseThrow(() => RosFailure(s"expected ROS 2 Foxy or newer: librcl has no $name"))
    linker.downcallHandle(symbol, signature)

  private def status(name: String, takes: MemoryLayout*): (String, MethodHandle) =
    name -> handle(name, FunctionDescriptor.of(JAVA_INT, takes*))

  val initOptions = status("rcl_init_options_init", ADDRESS, AllocatorLayout)
  val endOptions  = status("rcl_init_options_fini", ADDRESS)
  val init        = status("rcl_init", JAVA_INT, ADDRESS, ADDRESS, ADDRESS)
  val shutdown    = status("rcl_shutdown", ADDRESS)
  val endContext  = status("rcl_context_fini", ADDRESS)
  val initNode    = status("rcl_node_init", ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS)
  val endNode     = status("rcl_node_fini", ADDRESS)
  val initSender  = status("rcl_publisher_init", ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS)
  val endSender   = status("rcl_publisher_fini", ADDRESS, ADDRESS)
  val readersOf   = status("rcl_publisher_get_subscription_count", ADDRESS, ADDRESS)
  val publish     = status("rcl_publish_serialized_message", ADDRESS, ADDRESS, ADDRESS)
  val initReader  = status("rcl_subscription_init", ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS)
  val endReader   = status("rcl_subscription_fini", ADDRESS, ADDRESS)
  val take        = status("rcl_take_serialized_message", ADDRESS, ADDRESS, ADDRESS, ADDRESS)
  val initBytes   = status("rcutils_uint8_array_init", ADDRESS, JAVA_LONG, ADDRESS)
  val endBytes    = status("rcutils_uint8_array_fini", ADDRESS)
  val initWait    =
    status("rcl_wait_set_init", (ADDRESS +: Vector.fill(6)(JAVA_LONG)) ++ Vector(ADDRESS, AllocatorLayout)*)
  val clearWait  = status("rcl_wait_set_clear", ADDRESS)
  val addToWait  = status("rcl_wait_set_add_subscription", ADDRESS, ADDRESS, ADDRESS)
  val await      = status("rcl_wait", ADDRESS, JAVA_LONG)
  val endWait    = status("rcl_wait_set_fini", ADDRESS)
  val topicTypes = status("rcl_get_topic_names_and_types", ADDRESS, ADDRESS, JAVA_BOOLEAN, ADDRESS)
  val endTypes   = status("rcl_names_and_types_fini", ADDRESS)

  private val resetError = handle("rcutils_reset_error", FunctionDescriptor.ofVoid())

  /** A function that returns a struct by value.
    *
    * @param room upper bound of its size, bytes; more than 16, so that every platform returns it in memory
    */
  private def struct(name: String, room: Int): SegmentAllocator => MemorySegment =
    val function = handle(name, FunctionDescriptor.of(words(room / 8)))
    into => function.invokeWithArguments(into).asInstanceOf[MemorySegment]

  val allocator: SegmentAllocator => MemorySegment     = struct("rcutils_get_default_allocator", 40)
  val nodeOptions: SegmentAllocator => MemorySegment   = struct("rcl_node_get_default_options", 1024)
  val senderOptions: SegmentAllocator => MemorySegment = struct("rcl_publisher_get_default_options", 1024)
  val readerOptions: SegmentAllocator => MemorySegment = struct("rcl_subscription_get_default_options", 1024)
  private val errorText                                = struct("rcutils_get_error_string", 2048)

  /** Calls a function and returns its status; after one that is not [[Ok]], [[reason]] says why. */
  def status(function: (String, MethodHandle), arguments: Any*): Int =
    function._2.invokeWithArguments(arguments.map(_.asInstanceOf[AnyRef])*).asInstanceOf[Int]

  /** Calls a function that must succeed.
    *
    * @throws RosFailure if it fails, with the library's reason
    */
  def call(function: (String, MethodHandle), arguments: Any*): Unit =
    val result = status(function, arguments*)
    if result != Ok then throw RosFailure(s"${function._1}: ${reason(result)}")

  /** The library's own words about the last failure of this thread. */
  def reason(status: Int): String =
    val arena = Arena.ofConfined()
    try
      val text = errorText(arena).getString(0)
      resetError.invokeWithArguments(): Unit
      // The place in the library's source follows.
      s"${text.split(", at /").head} (status $status)"
    finally arena.close()

  private val supports = TrieMap.empty[String, Either[String, MemorySegment]]

  /** ROS 2's description of a message type such as `nav_msgs/msg/Odometry`, from the library of its package.
    *
    * @return Left if the package is not installed
    */
  def typeSupport(kind: String): Either[String, MemorySegment] =
    supports.getOrElseUpdate(kind, described(kind))

  private def described(kind: String): Either[String, MemorySegment] = kind match
    case Kind(packageName, name) => described(kind, packageName, name)
    case _                       => Left(s"expected a type such as nav_msgs/msg/Odometry, got $kind")

  private def described(kind: String, packageName: String, name: String): Either[String, MemorySegment] =
    val file   = System.mapLibraryName(s"${packageName}__rosidl_typesupport_c")
    val symbol = s"rosidl_typesupport_c__get_message_type_support_handle__${packageName}__msg__$name"
    for
      path <- folders.map(_.resolve(file)).find(Files.isRegularFile(_)).toRight(
        s"expected ROS 2's package $packageName for $kind, it is not installed"
      )
      library <- load(path)
      address <-
        Option(library.find(symbol).orElse(null)).toRight(s"$path: expected $kind, it has no $symbol")
    yield linker
      .downcallHandle(address, FunctionDescriptor.of(ADDRESS))
      .invokeWithArguments()
      .asInstanceOf[MemorySegment]

  /** The text of a type's `.msg` file, which is in the folder `share` beside `lib`; empty if there is none.
    */
  def definition(kind: String): String = kind match
    case Kind(packageName, name) =>
      folders
        .map(_.resolveSibling("share").resolve(packageName).resolve("msg").resolve(s"$name.msg"))
        .find(file => Files.isRegularFile(file) && Files.size(file) <= MostDefinition)
        .flatMap(file => Try(Files.readString(file)).toOption)
        .getOrElse("")
    case _ => ""

private[ros] object RosLibrary:
  val Ok: Int        = 0
  val TimedOut: Int  = 2
  val NothingToTake  = 401
  val NothingToAwait = 901

  private val Kind           = "([A-Za-z][A-Za-z0-9_]*)/msg/([A-Za-z][A-Za-z0-9_]*)".r
  private val MostDefinition = 64L << 10

  private[ros] def words(count: Int): StructLayout =
    MemoryLayout.structLayout(MemoryLayout.sequenceLayout(count, JAVA_LONG))

  /** `rcutils_allocator_t`: four functions and a state. */
  val AllocatorLayout: StructLayout = words(5)

  /** The library, or why there is none. It is searched for once, in the environment of this process. */
  lazy val here: Either[String, RosLibrary] =
    for
      folders <- folders(sys.env)
      path = folders.map(_.resolve(RclName)).find(Files.isRegularFile(_)).get
      rcl     <- load(path)
      utils   <- load(path.resolveSibling(System.mapLibraryName("rcutils")))
      library <- Try(RosLibrary(folders, name => rcl.find(name).or(() => utils.find(name)))).toEither.left
        .map(error => s"$path: ${error.getMessage}")
    yield library

  private val RclName = System.mapLibraryName("rcl")

  /** Folders with ROS 2's libraries, overlays first. Left says why there is no `librcl` in any of them. */
  private[ros] def folders(environment: Map[String, String]): Either[String, Vector[Path]] =
    def listed(variable: String) =
      environment.get(
        variable
      ).toVector.flatMap(_.split(File.pathSeparator)).filter(_.nonEmpty).map(Path.of(_))
    val all                     = (listed(Prefixes).map(_.resolve("lib")) ++ listed(Libraries)).distinct
    def state(variable: String) = if environment.get(variable).exists(_.nonEmpty) then "" else " (not set)"
    Either.cond(
      all.exists(folder => Files.isRegularFile(folder.resolve(RclName))),
      all,
      s"ROS 2 was not found: expected $RclName in lib of a folder of $Prefixes${state(Prefixes)} or in a folder " +
        s"of $Libraries${state(Libraries)}; run `source /opt/ros/DISTRO/setup.bash` first"
    )

  private val Prefixes  = "AMENT_PREFIX_PATH"
  private val Libraries = "LD_LIBRARY_PATH"

  private def load(path: Path): Either[String, SymbolLookup] =
    try Right(SymbolLookup.libraryLookup(path, Arena.global()))
    catch
      case error: IllegalArgumentException =>
        Left(s"$path cannot be loaded (${error.getMessage}): expected its folder in $Libraries, as ROS 2's " +
          "setup.bash sets it")
