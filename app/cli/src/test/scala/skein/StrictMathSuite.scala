package skein

import java.lang.classfile.instruction.{FieldInstruction, InvokeInstruction}
import java.lang.classfile.{ClassFile, CodeElement}
import java.nio.file.{Files, Path}
import scala.jdk.CollectionConverters.*

/** A flight's computations must have equal bits on every machine, and so must a recording. The functions of
  * `java.lang.Math` listed here may differ in the last bit between processors; those of `StrictMath` may not.
  */
class StrictMathSuite extends munit.FunSuite:
  private val platformOwners = Set("java/lang/Math", "scala/math/package$", "scala/math/package")
  private val lanes          = "jdk/incubator/vector/VectorOperators"
  private val functions      =
    Set(
      "sin",
      "cos",
      "tan",
      "asin",
      "acos",
      "atan",
      "atan2",
      "exp",
      "expm1",
      "log",
      "log10",
      "log1p",
      "pow",
      "hypot"
    ) ++
      Set("cbrt", "sinh", "cosh", "tanh")

  test("no class that affects a flight calls a function whose last bit depends on the platform"):
    val modules = Seq(
      classOf[units.Vector3],
      classOf[forward.Rollout.type],
      classOf[link.Transport],
      classOf[flow.Sense.type],
      classOf[rpc.RpcClient],
      classOf[simulator.World],
      classOf[record.Recording],
      classOf[loop.Team]
    ).map(folderOf)
    val classes = modules.flatMap(classFiles)
    assert(classes.sizeIs > 500, s"found ${classes.size} classes under ${modules.mkString(", ")}")
    assertEquals(classes.flatMap(platformFunctions), Seq.empty)

  test("the check finds such a call"):
    val own =
      classFiles(folderOf(getClass)).filter(_.getFileName.toString.startsWith("StrictMathSuite$Offender"))
    assertEquals(own.flatMap(platformFunctions).distinct.size, 2)

  object Offender:
    def byScala(x: Double): Double = math.sin(x)
    def byJava(x: Double): Double  = Math.log(x)

  private def folderOf(some: Class[?]): Path =
    Path.of(some.getProtectionDomain.getCodeSource.getLocation.toURI)

  private def classFiles(folder: Path): Seq[Path] =
    val found = Files.walk(folder)
    try found.iterator.asScala.filter(_.toString.endsWith(".class")).toVector
    finally found.close()

  private def platformFunctions(file: Path): Seq[String] =
    for
      method <- ClassFile.of().parse(file).methods.asScala.toSeq
      code   <- Option(method.code.orElse(null)).toSeq
      called <- code.elementList.asScala.flatMap(platformFunction)
    yield s"${file.getFileName}: ${method.methodName.stringValue} takes $called"

  private def platformFunction(element: CodeElement): Option[String] = element match
    case call: InvokeInstruction
        if platformOwners(call.owner.asInternalName) && functions(call.name.stringValue) =>
      Some(s"${call.owner.asInternalName}.${call.name.stringValue}")
    case field: FieldInstruction
        if field.owner.asInternalName == lanes && functions(
          field.name.stringValue.toLowerCase(java.util.Locale.ROOT)
        ) =>
      Some(s"VectorOperators.${field.name.stringValue}")
    case _ => None
