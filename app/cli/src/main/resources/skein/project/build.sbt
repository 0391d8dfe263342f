ThisBuild / scalaVersion := "@SCALA@"

// Everything that Skein's own commands need; the agent lets tests and flights run in virtual time.
lazy val root = project
  .in(file("."))
  .settings(
    name                 := "@NAME@",
    libraryDependencies ++= Seq(
      "io.github.skein-uav" %% "skein-cli" % "@VERSION@",
      "org.scalameta"       %% "munit"     % "1.3.0" % Test
    ),
    scalacOptions ++= Seq("-Wunused:all", "-deprecation", "-feature"),
    Test / fork          := true,
    Test / javaOptions ++= options :+ agent((Test / dependencyClasspath).value),
    // What ./skein starts: the JVM's options and the classpath.
    launch               := {
      val classpath = (Runtime / fullClasspath).value
      val quoted    = (options :+ agent(classpath)) ++
        Seq("-cp", classpath.files.mkString(java.io.File.pathSeparator)) :+ "@PACKAGE@.Main"
      IO.write(target.value / "launch", quoted.map(word => "\"" + word.replace("\\", "\\\\") + "\"\n").mkString)
    }
  )

val launch = taskKey[Unit]("writes what ./skein starts")

lazy val options = Seq("--enable-native-access=ALL-UNNAMED", "--sun-misc-unsafe-memory-access=allow", "-Xlog:disable") ++
  Seq("-XX:+UseParallelGC", "-Xms384m", "-Xmn256m", "-XX:MaxTenuringThreshold=1")

def agent(classpath: Def.Classpath): String =
  "-javaagent:" + classpath.files.find(_.getName.startsWith("skein-vtime-agent")).get
