import Dependencies.*

ThisBuild / organization := "skein"
ThisBuild / version      := "0.1.0-SNAPSHOT"
ThisBuild / scalaVersion := "3.8.4"
ThisBuild / scalacOptions ++= Seq(
  "-Werror",
  "-Wunused:all",
  "-Wvalue-discard",
  "-deprecation",
  "-feature",
  "-unchecked"
)
// What is built at its first start need not wait for archives that nobody publishes.
ThisBuild / packageDoc / publishArtifact := false
ThisBuild / packageSrc / publishArtifact := false
ThisBuild / Test / fork               := true
ThisBuild / run / fork                := true
ThisBuild / Test / testForkedParallel := false
ThisBuild / Test / javaOptions ++= Jvm.options
ThisBuild / run / javaOptions ++= Jvm.options
Global / onChangedBuildSource   := ReloadOnSourceChanges
Global / concurrentRestrictions := Seq(Tags.limitAll(2), Tags.limit(Tags.ForkedTestGroup, 1))

lazy val root =
  project.in(file(".")).aggregate(core, vtimeAgent, vtime, live, app, bench, benchJmh).settings(publish / skip := true)

/** Pure: units, signals, vehicle dynamics, policies, forward simulation. No Pekko, no I/O, no clock. */
lazy val core = project.settings(
  Jvm.vectorModule,
  libraryDependencies ++= munit
)

/** Rewrites clock readings as classes load. Java alone; the JVM is started with its jar as `-javaagent`. */
lazy val vtimeAgent = project
  .in(file("vtime-agent"))
  .settings(
    name             := "vtime-agent",
    crossPaths       := false,
    autoScalaLibrary := false,
    exportJars       := true,
    Compile / packageBin / packageOptions += Package.ManifestAttributes(
      "Premain-Class" -> "skein.vtime.agent.Agent"
    )
  )

/** For a module whose tests, or whose `run`, need virtual time: start their JVMs with the agent. */
lazy val underAgent = Seq(
  Test / javaOptions += s"-javaagent:${(vtimeAgent / Compile / packageBin).value}",
  run / javaOptions += s"-javaagent:${(vtimeAgent / Compile / packageBin).value}"
)

/** Any Pekko graph in virtual time. Depends on Pekko alone. */
lazy val vtime = project
  .dependsOn(vtimeAgent)
  .settings(underAgent, libraryDependencies ++= pekkoStream ++ munit ++ pekkoTyped.map(_ % Test))

/** Everything that touches the network and the clock, through interfaces that virtual time can replace. */
lazy val live = project
  .dependsOn(core, vtime % Test)
  .settings(underAgent)
  .settings(libraryDependencies ++= pekko ++ Seq(upickle, duckdb) ++ munit ++ Seq(
    streamTestkit,
    msgpackOracle
  ))

/** Commands and reports. */
lazy val app = project
  .dependsOn(live, vtime)
  .enablePlugins(JavaAppPackaging)
  .settings(underAgent)
  .settings(
    libraryDependencies ++= Seq(mainargs, pureconfig, logback, progressbar, scalatags) ++ munit,
    Compile / mainClass  := Some("skein.cli.Main"),
    executableScriptName := "skein",
    Universal / javaOptions ++= Jvm.nativeAccess.map("-J" + _),
    // A class-data archive, made at the first run, halves the start-up time; beside an agent it must be allowed.
    // It belongs to one set of modules. The JVM remarks on an incubator module in the first line of its standard
    // error, before any option or code of ours can prevent it: that line is taken out, and the rest passes as it comes.
    bashScriptExtraDefines ++= Seq(
      s"""addJava "-javaagent:$$lib_dir/${organization.value}.${(vtimeAgent / Compile / packageBin).value.getName}"""",
      """addJava "-XX:+UnlockDiagnosticVMOptions"""",
      """addJava "-XX:+AllowArchivingWithJavaAgent"""",
      """addJava "-XX:+AutoCreateSharedArchive"""",
      """case " $* " in""",
      """  " search "* | " budget "* | " replay "* | *" plan "* | *" --config "*)""",
      """    addJava "--add-modules=jdk.incubator.vector"""",
      """    addJava "-XX:SharedArchiveFile=${app_home}/../skein-vector.jsa"""",
      """    exec 2> >(""",
      """      trap '' INT""",
      """      if IFS= read -r first && [ "$first" != "WARNING: Using incubator modules: jdk.incubator.vector" ]; then""",
      """        printf '%s\n' "$first" >&2""",
      """      fi""",
      """      exec cat >&2""",
      """    )""",
      """    ;;""",
      """  *) addJava "-XX:SharedArchiveFile=${app_home}/../skein.jsa" ;;""",
      """esac""",
      // The experiment's seven flights of a minute in virtual time have landed before optimising them pays.
      """case " $* " in""",
      """  *" plan "*|*" --config"*|*" --duration"*|*" --pairs"*|*" --scenario"*) ;;""",
      """  *" fly"*" --clock"[\ =]"virtual "*) addJava "-XX:TieredStopAtLevel=1" ;;""",
      """esac""",
      // Whoever chooses a collector or sizes chooses them all.
      """case "${JAVA_OPTS-} $*" in""",
      """  *-Xm[nsx]*|*-XX:+Use*GC*) ;;""",
      s"""  *) ${Jvm.control.map(option => s"addJava $option").mkString("; ")} ;;""",
      """esac""",
      """addJava "-Xlog:disable""""
    )
  )

/** Measurements: plain programs that print a witness of what they did. */
lazy val bench =
  project
    .dependsOn(app)
    .settings(Jvm.vectorModule, underAgent, run / javaOptions ++= Jvm.control)
    .settings(publish / skip := true, libraryDependencies ++= munit)

/** By JMH; apart from `bench`, whose classes with vectors its generator cannot load. */
lazy val benchJmh =
  project.in(file("bench/jmh")).dependsOn(bench).enablePlugins(JmhPlugin).settings(publish / skip := true)
