mgt-rig table --rig random --seed 700734 --hide 2 --seal game-1.sealed -o game-1.csv
