import java.util.zip.{ZipEntry, ZipFile, ZipOutputStream}
import sbt.*
import sbt.io.Using
import scala.collection.JavaConverters.*
import scala.sys.process.Process

/** `./sbtw package`: Skein with a Java runtime of its own, for the platform on which it is made. */
object Packaging {
  val program: TaskKey[File] = taskKey[File]("Skein in a folder, with a runtime and an ahead-of-time cache")

  private val modules = Seq(
    "java.base",
    "java.desktop",
    "java.instrument",
    "java.logging",
    "java.management",
    "java.naming",
    "java.security.sasl",
    "java.sql",
    "jdk.incubator.vector",
    "jdk.jfr", // Pekko's remote nodes
    "jdk.management",
    "jdk.net",
    "jdk.unsupported",
    // JPype looks for packages in jars.
    "jdk.zipfs"
  )

  /** Where the vector module is resolved by itself, the JVM is not told to compile it specially. */
  private val vectors = Seq(
    "-XX:+UnlockExperimentalVMOptions",
    "-XX:+EnableVectorSupport",
    "-XX:+EnableVectorReboxing",
    "-XX:+EnableVectorAggressiveReboxing"
  )

  /** The first day that a ZIP archive can represent, ms, UTC: the time of all files, so that equal sources give equal bytes. */
  val firstDay = 315532800000L

  private val isMac = sys.props("os.name").startsWith("Mac")
  private val isArm = sys.props("os.arch") == "aarch64"

  /** The platform's name in archives, and in wheels. */
  val (platform, wheelPlatform): (String, String) = (isMac, isArm) match {
    case (false, false) => ("linux-x64", "linux_x86_64")
    case (false, true)  => ("linux-arm64", "linux_aarch64")
    case (true, false)  => ("macos-x64", "macosx_11_0_x86_64")
    case (true, true)   => ("macos-arm64", "macosx_11_0_arm64")
  }

  /** Whether a file in a jar is a library for this platform, or no library. */
  private def isWanted(name: String): Boolean = {
    val path        = name.toLowerCase
    val (os, other) = if (isMac) (Seq("darwin", "mac", "osx"), Nil) else (Seq("linux"), Seq("android", "musl"))
    val (cpu, foreign) =
      if (isArm) (Seq("aarch64", "arm64"), Seq("x86_64", "amd64")) else (Seq("x86_64", "amd64"), Seq("aarch64", "arm64"))
    val isLibrary = path.matches(""".*\.(so|dll|dylib|jnilib|a)(_[a-z0-9_]+)?""")
    // macOS has libraries for both of its processors in one file.
    val fits = cpu.exists(path.contains) || isMac && !foreign.exists(path.contains)
    !isLibrary || os.exists(path.contains) && fits && !other.exists(path.contains)
  }

  private val duckdb = "libduckdb_java.so"

  /** What few need is in an archive of its own: clients of Kafka, with its compression, and of Postgres. */
  private val extras = Seq("org.apache.kafka.", "org.xerial.snappy.", "org.postgresql.")

  /** Copies a jar without libraries for other platforms. DuckDB's, which it would write to a temporary file at every
    * start, goes beside its jar, where it looks for it, too.
    */
  private def copyJar(from: File, lib: File): Unit = {
    val zip = new ZipFile(from)
    val (unwanted, wanted) = zip.entries.asScala.toSeq.partition(entry => !isWanted(entry.getName))
    val (beside, inside)   = wanted.partition(_.getName.startsWith(duckdb))
    if (unwanted.isEmpty && beside.isEmpty) IO.copyFile(from, lib / from.getName)
    else
      Using.fileOutputStream()(lib / from.getName) { stream =>
        val out = new ZipOutputStream(stream)
        for (entry <- inside) {
          out.putNextEntry(new ZipEntry(entry.getName))
          IO.transfer(zip.getInputStream(entry), out)
          out.closeEntry()
        }
        out.finish()
      }
    for (entry <- beside) IO.transfer(zip.getInputStream(entry), lib / entry.getName)
    zip.close()
  }

  /** The folder of the same name as the program's, to be unpacked over it. */
  private def extrasOf(home: File) = home.getParentFile / "extras" / home.getName

  /** Makes the folder, and one of [[extras]]; removes those of other versions. A runtime that was linked before is kept.
    *
    * @param stage
    *   with `lib`
    * @param sources
    *   the folder of what only this needs
    * @param agent
    *   rewrites jars for virtual time, and for the cache
    */
  def build(stage: File, sources: File, notices: Seq[File], agent: File, home: File, log: Logger): File = {
    def run(in: File, command: String*): Unit = {
      val status = Process(command, in).!(log)
      if (status != 0) sys.error(s"${command.mkString(" ")} ended with status $status")
    }
    val (java, lib, runtime) = (s"${sys.props("java.home")}/bin/java", home / "lib", home / "runtime")
    val (linker, remembered) = (sources / "LinkRuntime.java", home.getParentFile / "runtime.txt")
    val options = Seq("--add-modules", modules.mkString(","), "--strip-debug", "--no-header-files", "--no-man-pages")
    val wanted  = (IO.read(file(sys.props("java.home")) / "release") +: IO.read(linker) +: options).mkString("\n")
    val isLinked = runtime.exists && remembered.exists && IO.read(remembered) == wanted
    IO.delete((home.getParentFile * "skein-*").get.filter(one => one.isDirectory && one != home) :+ extrasOf(home).getParentFile)
    IO.delete((home * "*").get.filterNot(isLinked && _ == runtime))
    IO.createDirectory(lib)
    (stage / "lib" * "*.jar").get.foreach(copyJar(_, lib))
    val brief = Seq(java, "-XX:+UseSerialGC", "-XX:TieredStopAtLevel=1")
    run(home, brief ++ Seq("-cp", agent.getPath, "skein.vtime.agent.RewriteJars", lib.getPath): _*)
    if (!isLinked) {
      val exports = Seq("internal", "plugin").flatMap(part => Seq("--add-exports", s"jdk.jlink/jdk.tools.jlink.$part=ALL-UNNAMED"))
      run(
        home,
        (brief :+ "--add-modules=jdk.jlink") ++ exports ++ (linker.getPath +: options) ++ Seq("--output", runtime.getPath): _*
      )
      IO.write(remembered, wanted)
    }

    val (extra, jars) = (lib * "*.jar").get.sortBy(_.getName).partition(jar => extras.exists(jar.getName.startsWith))
    extra.foreach(jar => IO.move(jar, extrasOf(home) / "lib" / "extra" / jar.getName))
    jars.foreach(_.setLastModified(firstDay))
    IO.touch(lib / ".timed")
    val launcher = home / "bin" / "skein"
    val words    = Map(
      "@BRIEF@"     -> IO.read(sources.getParentFile / "brief-flights").trim,
      "@CONTROL@"   -> Jvm.control.mkString(" "),
      "@OPTIONS@"   -> (Jvm.nativeAccess ++ vectors).mkString(" "),
      "@CLASSPATH@" -> jars.map(jar => s"$$lib/${jar.getName}").mkString(":")
    )
    IO.write(launcher, words.foldLeft(IO.read(sources / "skein")) { case (text, (word, value)) => text.replace(word, value) })
    launcher.setExecutable(true, false)
    notices.foreach(notice => IO.copyFile(notice, home / notice.getName))

    val classPath = jars.map(_.getPath).mkString(":")
    val aot       = (lib / "skein.aot").getPath
    val program   = (runtime / "bin" / "java").getPath +: (Jvm.nativeAccess ++ vectors ++ Jvm.control) :+ "-cp" :+ classPath
    val rehearsed = sources / "rehearsed"
    val answers   = lib / "answers"
    IO.createDirectory(answers)
    IO.withTemporaryDirectory { folder =>
      // The optimising compiler costs the rehearsal a fifth of its time, and its cache gains nothing by it.
      val cache  = program ++ Seq("-XX:TieredStopAtLevel=3", s"-XX:AOTCacheOutput=$aot")
      val status = Process(cache ++ Seq("skein.cli.Rehearsal", rehearsed.getPath, answers.getPath), folder).!(log)
      // What a busy machine did not fly is slower to start, no more.
      if (status != 0) log.warn("not all commands of the rehearsal ended well")
      if (!file(aot).exists) sys.error("the rehearsal made no ahead-of-time cache")
      val wanted = IO.readLines(rehearsed).flatMap(_.split(" > ").drop(1))
      wanted.filterNot(name => (answers / name).exists).foreach(name => sys.error(s"the rehearsal printed no $name"))
    }
    home
  }

  /** Packs the folder into an archive, and that of the extras into another. */
  def archive(home: File, log: Logger): File = {
    packed(extrasOf(home), home.getParentFile / s"${home.getName}-extras.tar.gz", log)
    packed(home, home.getParentFile / s"${home.getName}.tar.gz", log)
  }

  private def packed(folder: File, file: File, log: Logger): File = {
    val status = Process(Seq("tar", "-czf", file.getPath, folder.getName), folder.getParentFile).!(log)
    if (status != 0) sys.error(s"tar ended with status $status")
    log.info(s"$file: ${file.length >> 20} MiB")
    file
  }
}
