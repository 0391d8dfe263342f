package skein.cli

import com.typesafe.config.ConfigFactory
import java.lang.classfile.ClassFile
import java.lang.classfile.instruction.InvokeInstruction
import java.nio.file.{Files, Path}
import java.util.Locale
import scala.jdk.CollectionConverters.*
import skein.report.DuelReport
import skein.scenario.{Crossing, Scenarios}
import skein.settings.FlySettings
import skein.policy.Role
import skein.optimise.Objective

/** Skein's behaviour does not depend on locales in which i has no dot, digits are Arabic, or the decimal
  * point is a comma.
  */
class LocaleSuite extends munit.FunSuite:
  private given Scenarios = DuelReport.scenarios

  private val locales = Seq("tr-TR", "az-AZ", "lt-LT", "de-DE", "ar-EG-u-nu-arab", "hi-IN-u-nu-deva")

  for tag <- locales do
    test(s"settings, scenarios and objectives are read and printed in $tag as in any locale"):
      val before = Locale.getDefault
      Locale.setDefault(Locale.forLanguageTag(tag))
      try
        val settings = FlySettings.read(
          ConfigFactory
            .parseString("skein.fly { moves-in-flight = 3, scenario = crossing, crossing.minimum-m = 1.5 }")
            .withFallback(ConfigFactory.load())
        )
        assertEquals(
          settings.map(read => (read.movesInFlight, read.scenario)),
          Right((3, Crossing(minimumM = 1.5)))
        )
        assertEquals(Crossing().name, "crossing")
        assertEquals(Objective.ofRole("min", Role.Pursuer).map(_.text), Right("minimise min"))
      finally Locale.setDefault(before)

  test("an unknown option is reported in a Turkish locale as in any other"):
    val before = Locale.getDefault
    Locale.setDefault(Locale.forLanguageTag("tr-TR"))
    try
      val ran = Ran.of(SpreadCommand("skein.cli.Main").run(Seq("--moves-in-flight", "x")))
      assertEquals(ran.status, 2)
      assert(clue(ran.err).contains("--moves-in-flight: expected a whole number"))
    finally Locale.setDefault(before)

  private val always    = Set("toLowerCase()Ljava/lang/String;", "toUpperCase()Ljava/lang/String;")
  private val libraries = Seq(
    "format(Ljava/lang/String;[Ljava/lang/Object;)Ljava/lang/String;",
    "formatted([Ljava/lang/Object;)Ljava/lang/String;",
    "printf(Ljava/lang/String;[Ljava/lang/Object;)Ljava/io/PrintStream;",
    "format$extension(Ljava/lang/String;Lscala/collection/immutable/Seq;)Ljava/lang/String;"
  )

  test("no class changes the case of letters, and no library formats numbers, by the machine's locale"):
    // The commands set the locale before anything else, so code that belongs only to the program may format
    // by it.
    val (program, library) = folders.partition(_.startsWith(folderOf(Main.getClass).getParent))
    val files              = library.flatMap(classFiles)
    assert(clue(library).sizeIs > 5 && files.sizeIs > 500)
    val found = program.flatMap(classFiles).flatMap(calls).filter((_, called) => always(called)) ++
      files.flatMap(calls).filter((_, called) => always(called) || libraries.contains(called))
    assertEquals(found.map((where, called) => s"$where calls $called"), Nil)

  test("the check finds calls that depend on the locale"):
    val own = classFiles(folderOf(getClass)).filter(_.getFileName.toString.startsWith("LocaleSuite$Offender"))
    assertEquals(own.flatMap(calls).count((_, called) => always(called) || libraries.contains(called)), 3)

  object Offender:
    def lower(text: String): String     = text.toLowerCase
    def interpolated(x: Double): String = f"$x%.1f"
    def formatted(x: Double): String    = String.format("%.1f", x)

  private def folderOf(some: Class[?]): Path =
    Path.of(some.getProtectionDomain.getCodeSource.getLocation.toURI)

  /** Folders with our own modules' classes; libraries are in jars. */
  private def folders: Seq[Path] =
    sys.props(
      "java.class.path"
    ).split(java.io.File.pathSeparator).toSeq.map(Path.of(_)).filter(Files.isDirectory(_))
      .filterNot(_.getFileName.toString == "test-classes")

  private def classFiles(folder: Path): Seq[Path] =
    val found = Files.walk(folder)
    try found.iterator.asScala.filter(_.toString.endsWith(".class")).toVector
    finally found.close()

  /** Every call in a class: its caller, and the method's name with its type. */
  private def calls(file: Path): Seq[(String, String)] =
    for
      method <- ClassFile.of().parse(file).methods.asScala.toSeq
      code   <- Option(method.code.orElse(null)).toSeq
      call   <- code.elementList.asScala.collect { case call: InvokeInstruction => call }
    yield (
      s"${file.getFileName}: ${method.methodName.stringValue}",
      call.name.stringValue + call.`type`.stringValue
    )
