package skein.simulator

import java.lang.foreign.ValueLayout.{ADDRESS, JAVA_DOUBLE, JAVA_INT}
import java.lang.foreign.{Arena, FunctionDescriptor, Linker, MemoryLayout, MemorySegment, SymbolLookup}
import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*
import scala.util.Using

/** MuJoCo's C library (version 4), called as it is: a model from a text, stepped, with its state read and written whole.
  * Nothing of it lies in this project.
  */
private[simulator] final class Mujoco(library: Path, arena: Arena):
  private val linker = Linker.nativeLinker()
  private val lookup = SymbolLookup.libraryLookup(library, arena)

  private def function(name: String, returns: Option[MemoryLayout], takes: MemoryLayout*): Seq[Any] => Any =
    val shape  = returns.fold(FunctionDescriptor.ofVoid(takes*))(FunctionDescriptor.of(_, takes*))
    val handle = linker.downcallHandle(lookup.find(name).orElseThrow(), shape)
    arguments => handle.invokeWithArguments(arguments.map(_.asInstanceOf[AnyRef]).asJava)

  private val load      = function("mj_loadXML", Some(ADDRESS), ADDRESS, ADDRESS, ADDRESS, JAVA_INT)
  private val makeData  = function("mj_makeData", Some(ADDRESS), ADDRESS)
  private val step      = function("mj_step", None, ADDRESS, ADDRESS)
  private val stateSize = function("mj_stateSize", Some(JAVA_INT), ADDRESS, JAVA_INT)
  private val getState  = function("mj_getState", None, ADDRESS, ADDRESS, ADDRESS, JAVA_INT)
  private val setState  = function("mj_setState", None, ADDRESS, ADDRESS, ADDRESS, JAVA_INT)
  private val version   = function("mj_version", Some(JAVA_INT))

  /** Such as 4000000. */
  def versionNumber: Int = version(Nil).asInstanceOf[Int]

  /** A model in MuJoCo's XML. */
  final class World(xml: String):
    private val model =
      val file = Files.createTempFile("model", ".xml")
      try
        Files.writeString(file, xml)
        val error = arena.allocate(1000)
        val made  = load(Seq(arena.allocateFrom(file.toString), MemorySegment.NULL, error, 1000))
        val at    = made.asInstanceOf[MemorySegment]
        require(at.address != 0, error.getString(0))
        at
      finally Files.delete(file)
    private val data = makeData(Seq(model)).asInstanceOf[MemorySegment]

    /** Memory for one part of the state. */
    private val room = arena.allocate(JAVA_DOUBLE, 1000)

    def advance(): Unit =
      val _ = step(Seq(model, data))

    def read(part: Int): Vector[Double] =
      val _ = getState(Seq(model, data, room, part))
      Vector.tabulate(sizeOf(part))(room.getAtIndex(JAVA_DOUBLE, _))

    def write(part: Int, values: Seq[Double]): Unit =
      require(values.size == sizeOf(part), s"expected ${sizeOf(part)} numbers, came ${values.size}")
      values.zipWithIndex.foreach((value, index) => room.setAtIndex(JAVA_DOUBLE, index, value))
      val _ = setState(Seq(model, data, room, part))

    private def sizeOf(part: Int) = stateSize(Seq(model, part)).asInstanceOf[Int]

private[simulator] object Mujoco:
  /** Parts of the state (`mjtState`). */
  val Positions         = 1 << 1
  val Velocities        = 1 << 2
  val Controls          = 1 << 6
  val ForcesFromOutside = 1 << 8

  /** The library that `SKEIN_MUJOCO` names, or the one of PyPI's package, or why there is none. */
  def library(): Either[String, Path] = sys.env.get("SKEIN_MUJOCO") match
    case Some(path) =>
      Either.cond(Files.exists(Path.of(path)), Path.of(path), s"SKEIN_MUJOCO: there is no $path")
    case None => Package.install().flatMap: python =>
        val folder = python.getParent.getParent
        Using.resource(Files.walk(folder))(
          _.filter(_.getFileName.toString.startsWith("libmujoco."))
            .findFirst
            .map[Either[String, Path]](Right(_))
            .orElse(Left(s"no library below $folder"))
        )

  private val Package = PythonEnvironment("mujoco", "/mavlink/fly_mavsdk.py", Seq("mujoco==4.0.0"))
