use super::data::*;
#[test]
fn look() {
    let folder = std::env::temp_dir().join("look");
    std::fs::create_dir_all(&folder).unwrap();
    for n in [10, 1] {
        for task in [
            discrimination(n, 0.4),
            real_and_simulated(n, 0.4),
            localisation(n, 0.4),
            identification(n, 0.5),
            falls(n, &folder),
            forces(n, &folder),
            thresholds(n, 0.14),
            referral(n),
            same_or_different(n),
        ] {
            let at = std::time::Instant::now();
            let analysis = crate::Analysis {
                tasks: vec![crate::analyses::of_task(&task)],
            };
            println!("{} {:?}", task.name, at.elapsed());
            std::fs::write(
                folder.join(format!("{}-{n}.html", task.name)),
                analysis.page(),
            )
            .unwrap();
            std::fs::write(
                folder.join(format!("{}-{n}.json", task.name)),
                analysis.json(),
            )
            .unwrap();
        }
    }
}
